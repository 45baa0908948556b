// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/ImuAt.h"

#include <cmath>

namespace lintel {

namespace {

constexpr int kLeastSamples = 3;
constexpr double kLeastSpread = 0.25;  ///< deviation of the samples' times, of the reach; 0.29: many on one side

/// Sums over samples, at times relative to the one in question.
struct Moments {
  int n = 0;
  double t = 0, tt = 0;
  Eigen::Vector3d accel = Eigen::Vector3d::Zero(), gyro = Eigen::Vector3d::Zero(), t_gyro = Eigen::Vector3d::Zero();

  void add(const ImuSample& sample, double t_s) {
    ++n;
    t += t_s;
    tt += t_s * t_s;
    accel += sample.accel;
    gyro += sample.gyro;
    t_gyro += t_s * sample.gyro;
  }
};

}  // namespace

std::optional<ImuAt> imuAt(const ImuBatch& before, const ImuBatch& after, double reach_s) {
  if (before.empty() && after.empty()) return std::nullopt;
  const std::int64_t t_ns = before.empty() ? after.front().t_ns : before.back().t_ns;
  Moments m;
  const auto add = [&](const ImuSample& sample) {
    const double t_s = 1e-9 * static_cast<double>(sample.t_ns - t_ns);
    if (std::abs(t_s) > reach_s) return false;
    m.add(sample, t_s);
    return true;
  };
  for (auto sample = before.rbegin(); sample != before.rend() && add(*sample);) ++sample;
  // the sample at t ends the one batch and begins the other
  for (auto sample = after.begin() + (before.empty() || after.empty() ? 0 : 1); sample != after.end() && add(*sample);)
    ++sample;
  if (m.n < kLeastSamples) return std::nullopt;
  const double mean_t = m.t / m.n, variance = m.tt / m.n - mean_t * mean_t;
  if (variance < kLeastSpread * kLeastSpread * reach_s * reach_s) return std::nullopt;
  const Eigen::Vector3d slope = (m.t_gyro - mean_t * m.gyro) / (m.n * variance);
  return ImuAt{m.gyro / m.n - mean_t * slope, slope, m.accel / m.n};
}

std::optional<ImuAt> imuAt(const Preintegration* before, const Preintegration* after, double reach_s) {
  static const ImuBatch kNone;
  return imuAt(before ? before->samples() : kNone, after ? after->samples() : kNone, reach_s);
}

Eigen::Vector3d gyroAtEnd(const Preintegration& imu) {
  return imu.samples().empty() ? imu.bias().gyro : imu.samples().back().gyro;
}

MotionChange motionChange(const ImuAt& imu, const Eigen::Vector3d& accel_bias, const Eigen::Quaterniond& R_w_b,
                          const Eigen::Vector3d& gravity_w) {
  return {imu.accel - accel_bias + R_w_b.conjugate() * gravity_w, imu.gyro_slope};
}

}  // namespace lintel
