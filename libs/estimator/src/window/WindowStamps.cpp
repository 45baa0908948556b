// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowStamps.h"

#include <algorithm>

namespace lintel {

InertialState stateOf(const WindowFrame& frame) {
  return {frame.T_w_b(), velocityOf(frame.motion.data()), biasOf(frame.motion.data())};
}

Pose poseOfImage(const SlidingWindow& window, const InertialState& state, const Eigen::Vector3d& gyro) {
  const FrameMotion motion{state.T_w_b.q.conjugate() * state.v_w_b, gyro - state.bias.gyro};
  return poseAfter(state.T_w_b, motion, window.correction[kTimeOffsetAt]);
}

void addIntervals(const SlidingWindow& window, std::size_t first, StampJitter& jitter) {
  for (std::size_t k = std::max<std::size_t>(1, first); k < window.frames.size(); ++k)
    if (const WindowFrame& frame = window.frames[k]; frame.imu)
      jitter.add(stateOf(window.frames[k - 1]), stateOf(frame), *frame.imu);
}

void countStampJitter(double sigma_s, SlidingWindow& window) {
  for (std::size_t k = 1; k < window.frames.size(); ++k)
    if (Preintegration* imu = window.frames[k].imu.get(); imu && (sigma_s > 0 || imu->stampSigma() > 0))
      countStampJitter(sigma_s, stateOf(window.frames[k - 1]), stateOf(window.frames[k]), *imu);
}

}  // namespace lintel
