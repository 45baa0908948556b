// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/factors/RowMotion.h"
#include "lintel/mapping/MapMaterial.h"
#include "lintel/tracking/SegmentDetector.h"

namespace lintel {

/// Where the edges of a rolling shutter's image would have been at the frame's time, as tracked lines are kept: moved
/// by the camera's motion from their rows' times (RowMotion.h), as if they were as far away as points usually are.
/// Edges of a global shutter stay.
class RowTimes {
 public:
  explicit RowTimes(const MapMaterial& material);

  void move(std::size_t keyframe, std::vector<EdgeSegment>& edges) const;

 private:
  RowMotion motionDuring(std::size_t keyframe) const;
  Eigen::Vector3d turnRateByPoses_b(const RetiredKeyframe& keyframe) const;

  const MapMaterial& material_;
  double readout_s_;
  std::vector<double> inverse_distance_;  ///< usual, by keyframe; 0: of none
};

}  // namespace lintel
