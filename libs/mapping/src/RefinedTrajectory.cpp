// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "ImuWay.h"
#include "lintel/mapping/BatchRefinement.h"

namespace lintel {

namespace {

using TimedPose = std::pair<std::int64_t, Pose>;

/// What the causal trajectory says of the way between two refined keyframes.
class CausalWay {
 public:
  /// `start`, `end`: the causal poses at the times of the refined keyframes `from` and `to`.
  CausalWay(const Pose& start, const Pose& end, const RetiredKeyframe& from, const RetiredKeyframe& to)
      : start_(start.p), turn_(from.T_w_b.q * start.q.conjugate()), from_(from.T_w_b.p) {
    missing_ = to.T_w_b.p - (from_ + turn_ * (end.p - start_));
  }

  /// The position of a causal pose at the share `s` of the interval, so moved that both ends meet the keyframes.
  Eigen::Vector3d moved(const Pose& pose, double s) const { return from_ + turn_ * (pose.p - start_) + s * missing_; }

 private:
  Eigen::Vector3d start_;
  Eigen::Quaterniond turn_;
  Eigen::Vector3d from_, missing_;
};

/// Variance [m^2] of a position that the IMU gives at the share `s` of an interval of `T` seconds at whose ends
/// position and attitude are known, and the velocity is not: keyframes far apart say little of it. White noise of the
/// specific force is integrated twice, and the error of the attitude, a Brownian bridge, tilts gravity: with u = s (1 -
/// s)
///   q_a^2 T^3 u^2 / 3 + (g q_g)^2 T^5 u^2 (1 + 2 u) / 45.
double bridgeVariance(const Preintegration& imu, double T, double s) {
  const double u = s * (1 - s), q_a = imu.noise().accel_noise, g_q_g = imu.gravity_m_s2() * imu.noise().gyro_noise;
  return u * u * (q_a * q_a * std::pow(T, 3) / 3 + g_q_g * g_q_g * std::pow(T, 5) * (1 + 2 * u) / 45);
}

/// Poses of the frames `first` to `last` of the causal trajectory, between two keyframes: the IMU's, as long as it is
/// more precise than the images' of the causal trajectory.
void fillInterval(const RetiredKeyframe& from, const RetiredKeyframe& to, const CausalWay& way, const TimedPose* first,
                  const TimedPose* last, std::vector<TimedPose>& trajectory) {
  constexpr double kCausalSigma_m = 0.005;  // over four seconds with known ends: 1 to 5 mm on 17 of 18 recordings
  std::vector<std::int64_t> times;
  for (const TimedPose* frame = first; frame != last; ++frame) times.push_back(frame->first);
  const std::vector<Pose> poses = posesBetween(from, to, times);
  const double T = 1e-9 * static_cast<double>(to.t_ns - from.t_ns);
  for (std::size_t i = 0; first != last; ++i, ++first) {
    const double s = 1e-9 * static_cast<double>(times[i] - from.t_ns) / T;
    Pose T_w_b = poses[i];
    const double variance = bridgeVariance(*to.imu, T, s);
    T_w_b.p += variance / (variance + kCausalSigma_m * kCausalSigma_m) * (way.moved(first->second, s) - T_w_b.p);
    trajectory.emplace_back(times[i], T_w_b);
  }
}

}  // namespace

std::vector<TimedPose> refinedTrajectory(const MapMaterial& causal, const std::vector<RetiredKeyframe>& refined) {
  std::vector<TimedPose> result;
  if (refined.empty()) return causal.trajectory;
  const std::vector<TimedPose>& frames = causal.trajectory;
  // what a frame that the IMU does not reach moves by: the change of the keyframe `k`
  const auto movedWith = [&](std::size_t k, const TimedPose& frame) {
    const Pose T_w_e = refined[k].T_w_b * causal.keyframes[k].T_w_b.inverse();
    return std::make_pair(frame.first, T_w_e * frame.second);
  };
  // the causal pose at the time of the keyframe `k`: of the frame `at` if it is that one
  const auto causalAt = [&](std::size_t k, std::size_t at) {
    return at < frames.size() && frames[at].first == refined[k].t_ns ? frames[at].second : causal.keyframes[k].T_w_b;
  };
  std::size_t next = 0;
  while (next < frames.size() && frames[next].first < refined.front().t_ns)
    result.push_back(movedWith(0, frames[next++]));
  for (std::size_t k = 0; k < refined.size(); ++k) {
    const Pose start = causalAt(k, next);
    if (next < frames.size() && frames[next].first == refined[k].t_ns)
      result.emplace_back(frames[next++].first, refined[k].T_w_b);
    const std::int64_t until = k + 1 < refined.size() ? refined[k + 1].t_ns : INT64_MAX;
    std::size_t end = next;
    while (end < frames.size() && frames[end].first < until) ++end;
    if (k + 1 < refined.size() && refined[k + 1].imu && refined[k + 1].imu->dt_s() > 0) {
      const CausalWay way(start, causalAt(k + 1, end), refined[k], refined[k + 1]);
      fillInterval(refined[k], refined[k + 1], way, frames.data() + next, frames.data() + end, result);
      next = end;
    } else {
      for (; next < end; ++next) result.push_back(movedWith(k, frames[next]));
    }
  }
  return result;
}

}  // namespace lintel
