// SPDX-License-Identifier: BSD-3-Clause
#include "SpikeFilter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ImuValue.h"
#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr double kLeastGyro = 0.3, kLeastAccel = 3;  // rad/s, m/s^2: for 5 ms 0.1 degrees and 15 mm/s
constexpr double kUsual = 0.7;                       // of the samples around: two spikes spoil a quarter
constexpr double kTimes = 6;                         // what is usual: 6 standard deviations of white noise
constexpr double kAlike = 0.15, kNoise = 2;          // of the difference, times what is usual
constexpr std::int64_t kFar_ns = 100'000'000;        // from the sample before to the one after: a drop-out

bool isZero(const ImuSample& sample) {
  return sample.gyro == Eigen::Vector3d::Zero() && sample.accel == Eigen::Vector3d::Zero();
}

}  // namespace

/// By how much a value differs from the mean of its neighbours.
double SpikeFilter::difference(std::size_t i, int axis) const {
  return imuValue(samples_[i], axis) - 0.5 * (imuValue(samples_[i - 1], axis) + imuValue(samples_[i + 1], axis));
}

/// A single wrong value changes the differences of both its neighbours by minus a half of its own.
bool SpikeFilter::isSpike(std::size_t i, int axis) const {
  const double by = difference(i, axis);
  if (std::abs(by) < (axis < 3 ? kLeastGyro : kLeastAccel)) return false;
  std::vector<double> others;
  const std::size_t begin = std::max(i, kAround + 1) - kAround, end = std::min(i + kAround + 1, samples_.size() - 1);
  for (std::size_t j = begin; j < end; ++j)
    if (j != i) others.push_back(std::abs(difference(j, axis)));
  if (others.size() < kAround) return false;
  const auto usual = others.begin() + static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(others.size()));
  std::nth_element(others.begin(), usual, others.end());
  const auto isHalf = [&](std::size_t j) {
    if (j == 0 || j + 1 == samples_.size()) return true;
    return std::abs(difference(j, axis) + 0.5 * by) < kAlike * std::abs(by) + kNoise * *usual;
  };
  return std::abs(by) > kTimes * *usual && isHalf(i - 1) && isHalf(i + 1);
}

/// What is wrong with a sample, in words; empty: nothing.
std::string SpikeFilter::fault(std::size_t i) const {
  if (i == 0 || i + 1 >= samples_.size() || samples_[i + 1].t_ns - samples_[i - 1].t_ns > kFar_ns) return "";
  if (isZero(samples_[i]) && !isZero(samples_[i - 1]) && !isZero(samples_[i + 1])) return "all values are zero";
  for (int axis = 0; axis < 6; ++axis) {
    if (!isSpike(i, axis)) continue;
    return formatted("%s %.3g %s stands out from those around it",
                     axis < 3 ? "an angular rate of" : "an acceleration of", imuValue(samples_[i], axis),
                     axis < 3 ? "rad/s" : "m/s^2");
  }
  return "";
}

std::optional<ImuSample> SpikeFilter::pop(bool at_end, std::string& remark) {
  if (next_ == samples_.size() || (!at_end && next_ + kAround + 1 >= samples_.size())) return std::nullopt;
  const std::size_t i = next_++;
  ImuSample sample = samples_[i];
  remark = fault(i);
  if (!remark.empty()) {
    sample.gyro = 0.5 * (samples_[i - 1].gyro + samples_[i + 1].gyro);
    sample.accel = 0.5 * (samples_[i - 1].accel + samples_[i + 1].accel);
  }
  while (next_ > kAround + 2) samples_.pop_front(), --next_;
  return sample;
}

}  // namespace lintel
