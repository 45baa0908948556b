// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/NoiseMeter.h"

#include <algorithm>
#include <cmath>

#include "WhiteNoise.h"
#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr double kSpan_s = 2, kLeast_s = 0.25;
constexpr double kHidden = 3;  // how much more white noise there may be than the samples show
constexpr double kWhiteFor_s = 0.5;
constexpr double kUnderstated = 1.5;  // a data sheet that is wrong by less is kept
constexpr double kGyroVibrationShare = 0.3, kAccelVibrationShare = 0.15;
constexpr double kScaleError = 0.002;
constexpr double kScaleErrorLasts_s = 1;
constexpr double kCorrelated = 2.5;  // [sqrt(Hz)] the accelerometer's, per density of what vibration and motion leave

/// What sensors can do: from tactical grade to the cheapest in telephones.
struct Range {
  double low, high;
  double clamp(double value) const { return std::isfinite(value) ? std::clamp(value, low, high) : high; }
};
constexpr Range kGyroNoise{5e-5, 3e-3}, kAccelNoise{5e-4, 3e-2}, kGyroWalk{1e-5, 1e-3}, kAccelWalk{1e-4, 1e-2};

double seconds(const ImuSample& from, const ImuSample& to) { return 1e-9 * static_cast<double>(to.t_ns - from.t_ns); }

/// `quietest`: the smallest density that was measured; `shown`: that of white noise, if there was any. White noise is
/// always there: what was larger than the quietest was something else.
double white(double given, const Range& range, double quietest, const std::optional<double>& shown) {
  const double most = std::max(range.low, std::min(range.high, kHidden * quietest));
  const double value = Range{range.low, most}.clamp(given);
  const bool understated = shown && *shown > kUnderstated * value && *shown < kWhiteSpread * quietest;
  return understated ? range.clamp(*shown) : value;
}

/// Takes a density down once noise has been white for long enough.
void keepSmallest(const std::optional<double>& density, std::int64_t now_ns, std::int64_t& since_ns,
                  std::optional<double>& smallest) {
  if (!density) {
    since_ns = -1;
    return;
  }
  if (since_ns < 0) since_ns = now_ns;
  if (1e-9 * static_cast<double>(now_ns - since_ns) < kWhiteFor_s) return;
  smallest = std::min(smallest.value_or(*density), *density);
}

double sum(double white, double remaining_vibration, double motion) {
  const double slow = kScaleError * motion * std::sqrt(kScaleErrorLasts_s);
  return std::sqrt(white * white + remaining_vibration * remaining_vibration + slow * slow);
}

std::string remark(const char* what, double given, double taken, const char* unit) {
  if (given > taken / 1.01 && given < taken * 1.01) return {};
  return formatted("%s: %.2g %s are given, the samples show about %.2g", what, given, unit, taken);
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
  measureWhite(period_s);
}

void NoiseMeter::measureWhite(double period_s) {
  const std::int64_t now_ns = samples_.back().t_ns;
  const std::optional<double> gyro = whiteDensity(samples_, &ImuSample::gyro, now_->gyro_density, period_s);
  keepSmallest(gyro, now_ns, gyro_white_since_ns_, white_gyro_);
  const std::optional<double> accel =
      gyro ? whiteDensity(samples_, &ImuSample::accel, now_->accel_density, period_s) : std::nullopt;
  keepSmallest(accel, now_ns, accel_white_since_ns_, white_accel_);
}

ImuNoise whiteNoise(const ImuNoise& given, const NoiseMeter& meter) {
  ImuNoise noise{kGyroNoise.clamp(given.gyro_noise), kGyroWalk.clamp(given.gyro_walk),
                 kAccelNoise.clamp(given.accel_noise), kAccelWalk.clamp(given.accel_walk)};
  if (!meter.quietest()) return noise;
  const SampledNoise& quiet = *meter.quietest();
  noise.gyro_noise = white(given.gyro_noise, kGyroNoise, quiet.gyro_density, meter.whiteGyro());
  noise.accel_noise = white(given.accel_noise, kAccelNoise, quiet.accel_density, meter.whiteAccel());
  return noise;
}

ImuNoise effectiveNoise(const ImuNoise& given, const NoiseMeter& meter) {
  ImuNoise noise = whiteNoise(given, meter);
  if (!meter.now()) return noise;
  const SampledNoise& now = *meter.now();
  noise.gyro_noise = sum(noise.gyro_noise, kGyroVibrationShare * now.gyro_density, now.gyro_motion);
  noise.accel_noise = sum(noise.accel_noise, kAccelVibrationShare * now.accel_density, now.accel_motion);
  noise.accel_correlated = kCorrelated * sum(0, kAccelVibrationShare * now.accel_density, now.accel_motion);
  return noise;
}

std::string noiseRemark(const ImuNoise& given, const NoiseMeter& meter) {
  if (!meter.quietest()) return {};
  const ImuNoise taken = whiteNoise(given, meter);
  const std::string parts[] = {
      remark("gyroscope_noise_density", given.gyro_noise, taken.gyro_noise, "rad/s/sqrt(Hz)"),
      remark("accelerometer_noise_density", given.accel_noise, taken.accel_noise, "m/s^2/sqrt(Hz)"),
      remark("gyroscope_random_walk", given.gyro_walk, taken.gyro_walk, "rad/s^2/sqrt(Hz)"),
      remark("accelerometer_random_walk", given.accel_walk, taken.accel_walk, "m/s^3/sqrt(Hz)")};
  std::string all;
  for (const std::string& part : parts)
    if (!part.empty()) all += (all.empty() ? "" : "; ") + part;
  return all;
}

}  // namespace lintel
