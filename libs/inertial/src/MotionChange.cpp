// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/MotionChange.h"

#include <cmath>

namespace lintel {

namespace {

constexpr int kLeastSamples = 3;
constexpr double kLeastSpread =
    0.25;  ///< deviation of the samples' times, of `reach_s`: all of them on one side have 0.29

/// Sums over samples at times relative to one of them.
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

MotionChange motionChange(const ImuBatch& before, const ImuBatch& after, double reach_s, const ImuBias& bias,
                          const Eigen::Quaterniond& R_w_b, const Eigen::Vector3d& gravity_w) {
  if (before.empty() && after.empty()) return {};
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
  const double variance = m.n > 0 ? m.tt / m.n - (m.t / m.n) * (m.t / m.n) : 0;
  if (m.n < kLeastSamples || variance < kLeastSpread * kLeastSpread * reach_s * reach_s) return {};
  return {m.accel / m.n - bias.accel + R_w_b.conjugate() * gravity_w,
          (m.t_gyro - m.t / m.n * m.gyro) / (m.n * variance)};
}

}  // namespace lintel
