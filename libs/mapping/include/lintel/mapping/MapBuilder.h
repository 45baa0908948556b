// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "lintel/estimator/WindowUpdate.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

/// What becomes part of the map.
struct MapParams {
  int min_observations = 3;           ///< keyframes that saw a point or line
  double min_length_m = 0.05;         ///< of a segment
  double max_sigma_direction_rad = 0.10;
  double max_relative_sigma = 0.10;   ///< of a segment's position, relative to its distance from where it was seen
  double point_max_relative_sigma = 0.20;
  double coverage = 0.2;              ///< a piece of a line is drawn when this share of its observations (and two) saw it

  template <class F>
  void fields(F&& field) {
    field("min_observations", min_observations);
    field("min_length_m", min_length_m);
    field("max_sigma_direction_rad", max_sigma_direction_rad);
    field("max_relative_sigma", max_relative_sigma);
    field("point_max_relative_sigma", point_max_relative_sigma);
    field("coverage", coverage);
  }
};

/// Collects what leaves the window into a map.
class MapBuilder {
 public:
  MapBuilder(const Rig& rig, const MapParams& params) : rig_(rig), params_(params) {}

  /// Updates in the order of time.
  void add(const WindowUpdate& update);

  /// Calibration that the map's poses belong to.
  void setRig(const Rig& rig) { rig_ = rig; }

  /// The map of everything added so far; landmarks without sufficient evidence are left out.
  LineMap build() const;

 private:
  Rig rig_;
  MapParams params_;
  std::map<FrameId, RetiredKeyframe> keyframes_;
  std::vector<RetiredPoint> points_;
  std::vector<RetiredLine> lines_;
  std::vector<std::pair<std::int64_t, Pose>> trajectory_;
};

}  // namespace lintel
