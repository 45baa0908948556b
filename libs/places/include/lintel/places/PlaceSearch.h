// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "lintel/core/FrameTracks.h"
#include "lintel/core/ParamRange.h"
#include "lintel/geometry/Camera.h"
#include "lintel/geometry/Pose.h"
#include "lintel/places/PlaceView.h"

namespace lintel {

/// When two frames show the same place.
struct PlaceParams {
  bool enabled = true;
  double interval_s = 0.2;       ///< between frames that are described
  double keep_interval_s = 0.4;  ///< between those that the map keeps, with the IMU, for merging; 0: none
  double min_separation_s = 10;  ///< between the two visits
  int candidates = 4;            ///< earlier places that are tried for a keyframe
  int max_bits = 64;             ///< of 256 in which descriptors of one point may differ
  double max_error_px = 3;       ///< of a point of the earlier visit in the image of the later one
  int min_points = 12;           ///< that agree with one pose
  int min_cells = 5;             ///< of 16 of the image with such points
  int min_support = 3;           ///< other keyframes of the later visit that find the same drift
  double max_drift_m = 4;        ///< a larger one, and
  double max_drift_share = 0.1;  ///< this share of the way between more, is not believed

  template <class F>
  void fields(F&& field) {
    field("enabled", enabled);
    field("interval_s", interval_s, Range{0, 100});
    field("keep_interval_s", keep_interval_s, Range{0, 100});
    field("min_separation_s", min_separation_s, Range{1, 1e6});
    field("candidates", candidates, Range{1, 100});
    field("max_bits", max_bits, Range{1, 256});
    field("max_error_px", max_error_px, ReferencePixels{0.1, 100});
    field("min_points", min_points, Range{6, 1000});
    field("min_cells", min_cells, Range{1, 16});
    field("min_support", min_support, Range{0, 100});
    field("max_drift_m", max_drift_m, Range{0, 1e6});
    field("max_drift_share", max_drift_share, Range{0, 10});
  }
};

/// A described frame as the odometry has it.
struct PlaceKeyframe {
  Pose T_w_c;
  int run = 0;             ///< keyframes of different runs have different worlds
  double travelled_m = 0;  ///< since the first keyframe
  const PlaceView* view = nullptr;
  int flight = 0;  ///< runs of one flight follow each other in time and space
};

/// A point of which there are two tracks, one from an earlier visit.
struct SamePoint {
  TrackId earlier = 0, later = 0;
  int votes = 0;  ///< pairs of keyframes that say so
};

/// Two keyframes that show the same place, or seem to.
struct PlacePair {
  std::int64_t earlier_ns = 0, later_ns = 0;
  int points = 0;                      ///< that agree with one pose
  int support = 0;                     ///< other keyframes that find the same drift
  Pose T_w_c;                          ///< of the later one, in the world of the earlier
  double drift_m = 0;                  ///< how far the odometry has drifted between them
  double drift_rad = 0;                ///< and turned
  double apart_px = 0;                 ///< how far the odometry expects its points from where they are seen, median
  std::string refusal;                 ///< why they are not taken as the same place; empty: they are
  int earlier_run = 0, later_run = 0;  ///< when these differ there is no drift: the runs' worlds have nothing in common

  bool joinsRuns() const { return earlier_run != later_run; }
};

/// How the world of a run lies in that of an earlier one: places were found that both have seen.
struct RunAlignment {
  int run = 0, world = 0;  ///< the earlier run
  Pose world_from_run;     ///< keeps the vertical
  int keyframes = 0;       ///< that say so
};

struct PlaceReport {
  std::vector<PlacePair> pairs;          ///< ascending by the later time; accepted and refused
  std::vector<SamePoint> same;           ///< ascending by tracks
  std::vector<RunAlignment> alignments;  ///< ascending run; others have a world of their own
  std::size_t described = 0;             ///< keyframes
};

/// Finds places that were seen again, and points that were tracked there both times. Appearance proposes (WordIndex),
/// the geometry of the points decides (Resection), keyframes that follow each other must find the same drift. Poses of
/// the odometry are used for the vertical and for what a few seconds are known to, not for where the later visit was.
/// Runs whose worlds differ are aligned when enough keyframes of both show the same places.
/// `keyframes` ascending in time within a flight, runs one after another, with views; `points_w` positions of tracked
/// points. `progress` is called with the share that is done and ends the search by `false`. Throws
/// std::invalid_argument, naming the parameter, when one is out of range.
PlaceReport findPlaces(const Camera& camera, const std::vector<PlaceKeyframe>& keyframes,
                       const std::unordered_map<TrackId, Eigen::Vector3d>& points_w, const PlaceParams& params,
                       const std::function<bool(double)>& progress = {});

}  // namespace lintel
