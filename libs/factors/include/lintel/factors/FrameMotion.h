// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace lintel {

/// How a body moves at the time of an image, body axes: what a time offset does to the camera's pose. Taken from the
/// state, not from image velocities, whose noise would be correlated with the observation's own.
struct FrameMotion {
  Eigen::Vector3d v_b = Eigen::Vector3d::Zero();      ///< velocity [m/s]
  Eigen::Vector3d omega_b = Eigen::Vector3d::Zero();  ///< angular rate [rad/s]
};

}  // namespace lintel
