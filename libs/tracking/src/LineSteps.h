// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "ImageLine.h"
#include "VehicleParts.h"

namespace lintel {

/// Compares the lines of one detection with those of the detection before: which are where they were, and which moved
/// as the camera turned. A tracker cannot tell, as it looks for a line where the turn brings it.
class LineSteps {
 public:
  explicit LineSteps(const LineCamera& camera) : camera_(camera) {}

  /// Takes a step of the camera's rotation.
  void turn(const Eigen::Quaterniond& R_c2_c1) { R_c1_c0_ = (R_c2_c1 * R_c1_c0_).normalized(); }

  /// Places along the lines of the detection before, all in its image; lines that are found in neither place give none.
  std::vector<FollowedPoint> followed(const std::vector<ImageLine>& detected);

 private:
  void compare(const ImageLine& line, const std::vector<ImageLine>& detected,
               std::vector<FollowedPoint>& followed) const;

  const LineCamera& camera_;
  std::vector<ImageLine> before_;
  Eigen::Quaterniond R_c1_c0_ = Eigen::Quaterniond::Identity();  ///< c0: at the detection before
};

}  // namespace lintel
