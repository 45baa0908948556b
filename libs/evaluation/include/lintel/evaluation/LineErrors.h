// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "lintel/evaluation/TrueLines.h"
#include "lintel/geometry/Alignment.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

struct LineErrorParams {
  std::vector<double> tolerances_m = {0.02, 0.05, 0.10};  ///< distances up to which a piece counts as right [m]
  double step_m = 0.02;                                   ///< length of the pieces that segments are cut into [m]
  double max_angle_rad = 0.26179938779914943654;          ///< between a right segment and its edge: 15 degrees
  double match_distance_m = 0.25;                   ///< a piece votes for the nearest edge within this distance …
  double match_angle_rad = 0.52359877559829887308;  ///< … and this angle: 30 degrees
  double observable_length_m = 0.5;                 ///< edges count for recall from this length …
  int observable_frames = 60;                       ///< … if at least so many frames show them
};

/// Errors of the map's segments that have a true edge; NaN where there is none. Quantile q of n is the sorted value
/// number floor(q n), counted from 0.
struct SegmentErrors {
  std::size_t count = 0;
  double direction_median_rad = std::numeric_limits<double>::quiet_NaN();
  double direction_p90_rad = std::numeric_limits<double>::quiet_NaN();
  double distance_median_m = std::numeric_limits<double>::quiet_NaN();  ///< mean of both ends' distances to the edge
};

/// How far a line map is from the true edges. Shares are of length, one for each tolerance; NaN where there is no
/// length.
struct LineErrors {
  std::size_t lines = 0, degenerate = 0, constrained = 0;
  double length_m = 0;      ///< of the map
  double observable_m = 0;  ///< length of the true edges that count for recall
  std::vector<double> tolerances_m;
  std::vector<double>
      surface_precision;  ///< share of the map within tolerance of a true surface; empty if none is known
  // the measures of limap's evaluation [Liu2023]: metres of the map within tolerance of a true surface, and the share
  // of lines of which some piece is; empty if no surface is known
  std::vector<double> surface_length_m, surface_lines;
  std::vector<double> precision;  ///< share of the map within tolerance and angle of a true edge
  std::vector<double> recall;     ///< share of the observable edges within tolerance and angle of the map
  SegmentErrors all_matched, degenerate_matched, well_determined_matched;
  SegmentErrors constrained_matched;  ///< direction held by parallel lines; degenerate or not
  double duplicates =
      std::numeric_limits<double>::quiet_NaN();  ///< matched length / length of the edges it covers; 1 = none
  double true_duplicates =
      std::numeric_limits<double>::quiet_NaN();  ///< the same, without lines that images show side by side
};

/// Distance of a point of the true world to its nearest surface [m].
using SurfaceDistanceFunction = std::function<double(const Eigen::Vector3d&)>;

/// Compares the lines of a map, moved by `S_truth_map`, with the true edges. A segment is matched to the edge that most
/// of its pieces vote for, if that is at least half of them.
LineErrors evaluateLines(const std::vector<MapLine>& lines, const Similarity& S_truth_map,
                         const std::vector<TrueLine>& truth, const LineErrorParams& params = {},
                         const SurfaceDistanceFunction& surface_distance = {});

}  // namespace lintel
