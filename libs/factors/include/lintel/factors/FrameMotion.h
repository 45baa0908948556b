// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// How a body moves at the time of an image, body axes: what a time offset does to the camera's pose. Taken from the
/// state, not from image velocities, whose noise would be correlated with the observation's own.
struct FrameMotion {
  Eigen::Vector3d v_b = Eigen::Vector3d::Zero();      ///< velocity [m/s]
  Eigen::Vector3d omega_b = Eigen::Vector3d::Zero();  ///< angular rate [rad/s]
};

/// Where a body that is at `T_w_b` is `dt_s` later when it moves evenly, as the factors take it (CameraView.h).
Pose poseAfter(const Pose& T_w_b, const FrameMotion& motion, double dt_s);

/// When a row of a rolling shutter was exposed: `share` of the image's readout after the frame's time, -0.5 (first row)
/// to 0.5 (last row). The sighting has been moved to the frame's time already, as if the readout were wrong by
/// `known_s` (the correction block's unit).
struct RowTime {
  double share = 0, known_s = 0;

  /// How much later than the sighting's time it was exposed, if the readout is wrong by `readout_s` [s].
  double delay_s(double readout_s) const { return share * (readout_s - known_s); }
};

}  // namespace lintel
