// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/FrameMotion.h"

#include "lintel/geometry/Rotation.h"

namespace lintel {

Pose poseAfter(const Pose& T_w_b, const FrameMotion& motion, double dt_s) {
  return {(T_w_b.q * expRotation(motion.omega_b * dt_s)).normalized(), T_w_b.p + T_w_b.q * (motion.v_b * dt_s)};
}

}  // namespace lintel
