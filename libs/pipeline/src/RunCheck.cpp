// SPDX-License-Identifier: BSD-3-Clause
#include "RunCheck.h"

#include <cstdio>

namespace lintel {

namespace {

// What is carried, drives or flies slowly does not gain 15 m/s in five seconds; a gravity that is tilted by 18 degrees
// against the estimate's, or an accelerometer that is not what it is taken for, makes it seem so.
constexpr std::int64_t kSpan_ns = 5'000'000'000;
constexpr double kLargestAcceleration = 3;  // [m/s^2]
constexpr double kLeastShareWithPose = 0.5;

}  // namespace

void RunCheck::add(const ImuBatch& imu, const WindowUpdate& update) {
  if (update.status == EstimatorStatus::kTracking) bias_gyro_ = update.bias.gyro;
  accelerometer_.add(imu, bias_gyro_);
  noise_.add(imu);
  watchSpeed(update);
}

void RunCheck::watchSpeed(const WindowUpdate& update) {
  if (!update.hasPose()) speeds_.clear();
  if (update.status != EstimatorStatus::kTracking) return;
  speeds_.push_back({update.t_ns, update.v_w_b});
  if (update.t_ns - speeds_.front().t_ns < kSpan_ns) return;
  const double dt = 1e-9 * static_cast<double>(update.t_ns - speeds_.front().t_ns);
  const double acceleration = (update.v_w_b - speeds_.front().v_w_b).norm() / dt;
  if (!(acceleration <= largest_acceleration_)) largest_acceleration_ = acceleration;  // NaN, too
  speeds_.pop_front();
}

std::string RunCheck::verdict(const OdometryStatistics& s) const {
  std::string fault = accelerometer_.sizeFault();
  if (!fault.empty()) return fault;
  char text[200];
  const double after_first = static_cast<double>(s.last_frame_ns - s.first_frame_ns) * 1e-9 - s.first_pose_s;
  const double all = static_cast<double>(s.last_frame_ns - s.first_frame_ns) * 1e-9;
  const double expected = s.first_pose_s < 0 || all <= 0 ? 0 : static_cast<double>(s.frames) * after_first / all;
  if (!(largest_acceleration_ < kLargestAcceleration)) {
    std::snprintf(text, sizeof text, "the estimate diverged: it gained %.0f m/s within 5 s", 5 * largest_acceleration_);
    fault = text;
  } else if (s.resets > 0 && static_cast<double>(s.frames_with_pose) < kLeastShareWithPose * expected) {
    std::snprintf(text, sizeof text, "the estimate did not last: %zu starts, poses for %.0f %% of the frames",
                  s.resets + 1, 100 * static_cast<double>(s.frames_with_pose) / static_cast<double>(s.frames));
    fault = text;
  }
  if (fault.empty()) return fault;
  const std::string axes = accelerometer_.axesFault();
  return fault + (axes.empty() ? "; check that IMU and images belong together, T_BS of both, and the calibration"
                               : "; " + axes);
}

}  // namespace lintel
