// SPDX-License-Identifier: BSD-3-Clause
#include "window/FailureDetection.h"

namespace lintel {

std::string findFailure(const SlidingWindow& window, const FailureParams& params, const Pose& predicted_T_w_b) {
  const WindowFrame& newest = window.frames.back();
  const Pose T_w_b = newest.T_w_b();
  if (!newest.pose.allFinite() || !newest.motion.allFinite()) return "the estimate is not finite";
  const ImuBias bias = biasOf(newest.motion.data());
  if (bias.accel.norm() > params.max_bias_accel) return "the accelerometer bias is implausible";
  if (bias.gyro.norm() > params.max_bias_gyro) return "the gyroscope bias is implausible";
  if ((T_w_b.p - predicted_T_w_b.p).norm() > params.max_step_m)
    return "the position jumped away from the IMU's prediction";
  if (T_w_b.q.angularDistance(predicted_T_w_b.q) > params.max_step_rad)
    return "the orientation jumped away from the IMU's prediction";
  return {};
}

}  // namespace lintel
