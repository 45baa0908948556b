// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/ParamRange.h"

namespace lintel {

/// When two landmarks are taken as the same one.
struct MergeParams {
  bool lines = true;
  bool points = true;                 ///< joins tracks of the same landmark
  double max_angle_rad = 0.06;        ///< between two pieces of one line
  double max_offset_m = 0.10;         ///< across, and
  double max_relative_offset = 0.02;  ///< of the distance they were seen from: the larger one counts
  double max_gap_m = 0.10;            ///< along, between two pieces, and
  double max_relative_gap = 0.10;     ///< of the shorter one's length
  double max_error_px = 1.2;          ///< mean error of all views when joined
  double max_drift_px = 4.0;          ///< more than that between two passes, before the trajectory is refined
  double min_separation_px = 2.5;     ///< lines seen side by side in one image, farther apart, are two lines
  double point_max_error_px = 1.0;    ///< mean error of all views of a joined point

  template <class F>
  void fields(F&& field) {
    field("lines", lines);
    field("points", points);
    field("max_angle_rad", max_angle_rad, Range{0.0001, 1.5});
    field("max_offset_m", max_offset_m, Range{0, 100});
    field("max_relative_offset", max_relative_offset, Range{0, 10});
    field("max_gap_m", max_gap_m, Range{0, 1000});
    field("max_relative_gap", max_relative_gap, Range{0, 100});
    field("max_error_px", max_error_px, Range{0.01, 1000});
    field("max_drift_px", max_drift_px, ReferencePixels{0, 1000});
    field("min_separation_px", min_separation_px, Range{0.1, 1000});
    field("point_max_error_px", point_max_error_px, Range{0.01, 1000});
  }
};

/// How close parallel lines may stand in the map.
struct SpacingParams {
  double min_m = 0.05;         ///< of those closer only the better observed is drawn; 0: all are
  double min_relative = 0.03;  ///< of the distance they were seen from: the smaller one counts

  template <class F>
  void fields(F&& field) {
    field("min_m", min_m, Range{0, 100});
    field("min_relative", min_relative, Range{0, 10});
  }
};

/// Parallel groups.
struct GroupParams {
  double max_angle_rad = 0.05;  ///< of a member from the group's direction
  int min_lines = 5;
  double min_share = 0.03;  ///< of the map's length

  template <class F>
  void fields(F&& field) {
    field("max_angle_rad", max_angle_rad, Range{0.0001, 1.5});
    field("min_lines", min_lines, Range{2, 10000});
    field("min_share", min_share, Range{0, 1});
  }
};

/// What becomes part of the map.
struct MapParams {
  int min_observations = 3;        ///< keyframes that saw a point or line
  double min_length_m = 0.05;      ///< of a segment
  double min_depth_m = 0.1;        ///< nearer landmarks are left out
  double max_error_px = 1.5;       ///< mean distance of the views from the projected line
  double view_max_error_px = 3.0;  ///< a view farther off is an outlier
  double min_inlier_share = 0.6;   ///< of a line's views
  double max_sigma_direction_rad = 0.10;
  /// Of a segment's ends, across it, d away from where it was seen:
  /// at most min(max(max_sigma_m, max_far_sigma d), max_relative_sigma d).
  double max_sigma_m = 0.03, max_far_sigma = 0.003, max_relative_sigma = 0.02;
  double least_share = 0.5;  ///< of the length known to max_relative_sigma: max_far_sigma is raised where less is drawn
  double point_max_relative_sigma = 0.20;
  double coverage = 0.2;  ///< a piece of a line is drawn when this share of the views that would see it (and two) do
  MergeParams merge;
  GroupParams groups;
  SpacingParams spacing;
  /// use: drawn as they are; drop: left out; constrain: tied to parallel ones and drawn where that makes them known.
  /// No key of its own: estimator.degeneracy.lines.
  std::string degenerate_lines = "constrain";

  template <class F>
  void fields(F&& field) {
    field("min_observations", min_observations, Range{2, 1000});
    field("min_length_m", min_length_m, Range{0, 1000});
    field("min_depth_m", min_depth_m, Range{0, 1000});
    field("max_error_px", max_error_px, Range{0.01, 1000});
    field("view_max_error_px", view_max_error_px, Range{0.01, 1000});
    field("min_inlier_share", min_inlier_share, Range{0, 1});
    field("max_sigma_direction_rad", max_sigma_direction_rad, Range{0.0001, 10});
    field("max_sigma_m", max_sigma_m, Range{1e-6, 1000});
    field("max_far_sigma", max_far_sigma, Range{0, 100});
    field("max_relative_sigma", max_relative_sigma, Range{1e-6, 100});
    field("least_share", least_share, Range{0, 1});
    field("point_max_relative_sigma", point_max_relative_sigma, Range{1e-6, 100});
    field("coverage", coverage, Range{0, 1});
    field("merge", merge);
    field("groups", groups);
    field("spacing", spacing);
  }
};

}  // namespace lintel
