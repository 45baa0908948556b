// SPDX-License-Identifier: BSD-3-Clause
#include "window/FailureDetection.h"

#include "lintel/core/ParamRange.h"

namespace lintel {

namespace {

constexpr std::size_t kSecond = 10;  // window frames

}  // namespace

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

void PlacementCheck::add(const SlidingWindow& window) {
  constexpr std::size_t kSightings = 3;
  const double parallax_rad = 5 / kReferenceFocal_px;
  const auto ray = [&](const PointSighting& s) {
    return window.frame(s.frame).T_w_b().q * (window.T_b_c().q * s.observation.ray.normalized());
  };
  Count count;
  for (const auto& [id, track] : window.points) {
    if (track.sightings.size() < kSightings || track.sightings.back().frame != window.frames.back().id) continue;
    ++count.points;
    count.placed += track.triangulated;
    if ((ray(track.sightings.front()) - ray(track.sightings.back())).norm() < parallax_rad) continue;
    ++count.moving;
    count.moving_placed += track.triangulated;
  }
  counts_.push_back(count);
  if (counts_.size() > kSecond) counts_.pop_front();

  constexpr int kFew = 50;              // say nothing: a moving object alone
  constexpr double kLeastPlaced = 0.5;  // in good runs 0.85 and more, but for the moment of a take-off
  Count sum;
  for (const Count& c : counts_) {
    sum.points += c.points;
    sum.placed += c.placed;
    sum.moving += c.moving;
    sum.moving_placed += c.moving_placed;
  }
  const bool moving_have_none = sum.moving >= kFew && sum.moving_placed < kLeastPlaced * sum.moving;
  moving_frames_ = moving_have_none ? moving_frames_ + 1 : 0;
  frames_ = moving_have_none && sum.placed < kLeastPlaced * sum.points ? frames_ + 1 : 0;
}

bool PlacementCheck::contradicted(bool on_trial) const {
  constexpr int kOnTrial = 3;
  return on_trial ? moving_frames_ >= kOnTrial : frames_ >= static_cast<int>(kSecond);
}

}  // namespace lintel
