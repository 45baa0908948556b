// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/NoiseMeter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lintel {

namespace {

constexpr double kSpan_s = 2, kLeast_s = 0.25;
constexpr double kHidden = 3;  // how much more white noise there may be than the samples show
constexpr double kVibrationShare = 0.15;
constexpr double kScaleError = 0.002;
constexpr double kScaleErrorLasts_s = 1;

/// What sensors can do: from tactical grade to the cheapest in telephones.
struct Range {
  double low, high;
  double clamp(double value) const { return std::isfinite(value) ? std::clamp(value, low, high) : high; }
};
constexpr Range kGyroNoise{5e-5, 3e-3}, kAccelNoise{5e-4, 3e-2}, kGyroWalk{1e-5, 1e-3}, kAccelWalk{1e-4, 1e-2};

double seconds(const ImuSample& from, const ImuSample& to) { return 1e-9 * static_cast<double>(to.t_ns - from.t_ns); }

double white(double given, const Range& range, double measured) {
  const double most = std::max(range.low, std::min(range.high, kHidden * measured));
  return Range{range.low, most}.clamp(given);
}

double sum(double white, double vibration, double motion) {
  const double slow = kScaleError * motion * std::sqrt(kScaleErrorLasts_s), remains = kVibrationShare * vibration;
  return std::sqrt(white * white + remains * remains + slow * slow);
}

std::string remark(const char* what, double given, double taken, const char* unit) {
  if (given > taken / 1.01 && given < taken * 1.01) return {};
  char text[200];
  std::snprintf(text, sizeof text, "%s: %.2g %s are given, the samples show about %.2g", what, given, unit, taken);
  return text;
}

}  // namespace

void NoiseMeter::add(const ImuBatch& batch) {
  for (std::size_t i = 1; i + 1 < batch.size(); ++i)
    if (batch[i].bridged)
      samples_.clear();  // interpolated: it has no noise
    else if (samples_.empty() || batch[i].t_ns > samples_.back().t_ns)
      samples_.push_back(batch[i]);
  if (samples_.empty()) return;
  while (seconds(samples_.front(), samples_.back()) > kSpan_s) samples_.pop_front();
  measure();
}

void NoiseMeter::measure() {
  const double span_s = seconds(samples_.front(), samples_.back());
  if (span_s < kLeast_s || samples_.size() < 20) return;
  Eigen::Vector3d mean_gyro = Eigen::Vector3d::Zero(), mean_accel = Eigen::Vector3d::Zero();
  for (const ImuSample& s : samples_) mean_gyro += s.gyro, mean_accel += s.accel;
  const auto n = static_cast<double>(samples_.size());
  mean_gyro /= n;
  mean_accel /= n;
  const double period_s = span_s / (n - 1);
  SampledNoise seen;
  double triples = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    seen.gyro_motion += (samples_[i].gyro - mean_gyro).squaredNorm() / n;
    seen.accel_motion += (samples_[i].accel - mean_accel).squaredNorm() / n;
    if (i < 2) continue;
    const ImuSample &s0 = samples_[i - 2], &s1 = samples_[i - 1], &s2 = samples_[i];
    const double whole = seconds(s0, s2), b = seconds(s0, s1) / whole, a = 1 - b;
    if (whole > 4 * period_s) continue;  // a sample is missing: motion would count
    const double norm = 3 * (1 + a * a + b * b);
    seen.gyro_density += (s1.gyro - a * s0.gyro - b * s2.gyro).squaredNorm() / norm;
    seen.accel_density += (s1.accel - a * s0.accel - b * s2.accel).squaredNorm() / norm;
    triples += 1;
  }
  if (triples < 10) return;
  seen.gyro_density = std::sqrt(seen.gyro_density / triples * period_s);
  seen.accel_density = std::sqrt(seen.accel_density / triples * period_s);
  seen.gyro_motion = std::sqrt(seen.gyro_motion);
  seen.accel_motion = std::sqrt(seen.accel_motion);
  now_ = seen;
  if (!quietest_) quietest_ = seen;
  quietest_->gyro_density = std::min(quietest_->gyro_density, seen.gyro_density);
  quietest_->accel_density = std::min(quietest_->accel_density, seen.accel_density);
}

ImuNoise effectiveNoise(const ImuNoise& given, const NoiseMeter& meter) {
  ImuNoise noise{kGyroNoise.clamp(given.gyro_noise), kGyroWalk.clamp(given.gyro_walk),
                 kAccelNoise.clamp(given.accel_noise), kAccelWalk.clamp(given.accel_walk)};
  if (!meter.now()) return noise;
  const SampledNoise &now = *meter.now(), &quiet = *meter.quietest();
  noise.gyro_noise = sum(white(given.gyro_noise, kGyroNoise, quiet.gyro_density), now.gyro_density, now.gyro_motion);
  noise.accel_noise =
      sum(white(given.accel_noise, kAccelNoise, quiet.accel_density), now.accel_density, now.accel_motion);
  return noise;
}

std::string noiseRemark(const ImuNoise& given, const NoiseMeter& meter) {
  if (!meter.quietest()) return {};
  const SampledNoise& quiet = *meter.quietest();
  const std::string parts[] = {
      remark("gyroscope_noise_density", given.gyro_noise, white(given.gyro_noise, kGyroNoise, quiet.gyro_density),
             "rad/s/sqrt(Hz)"),
      remark("accelerometer_noise_density", given.accel_noise,
             white(given.accel_noise, kAccelNoise, quiet.accel_density), "m/s^2/sqrt(Hz)"),
      remark("gyroscope_random_walk", given.gyro_walk, kGyroWalk.clamp(given.gyro_walk), "rad/s^2/sqrt(Hz)"),
      remark("accelerometer_random_walk", given.accel_walk, kAccelWalk.clamp(given.accel_walk), "m/s^3/sqrt(Hz)")};
  std::string all;
  for (const std::string& part : parts)
    if (!part.empty()) all += (all.empty() ? "" : "; ") + part;
  return all;
}

}  // namespace lintel
