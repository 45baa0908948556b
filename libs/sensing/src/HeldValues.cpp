// SPDX-License-Identifier: BSD-3-Clause
#include "HeldValues.h"

#include <cmath>

#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr double kLeastRuns = 30;     // to say how they come
constexpr double kLeastLength = 1.4;  // samples that have a value, on average
constexpr double kRegular = 0.5;      // of the variance of lengths that chance makes, as with a coarse sensor at rest
constexpr double kReach = 3;          // average lengths without a new value: the sensor has stopped

}  // namespace

void HeldValues::look() {
  looked_ = true;
  for (Sensor& sensor : sensors_) {
    double runs = -1, sum = 0, squares = 0, length = 0;  // the first run may have begun before
    for (std::size_t i = 1; i < samples_.size(); ++i) {
      ++length;
      if (samples_[i].*sensor.values == samples_[i - 1].*sensor.values) continue;
      if (++runs > 0) sum += length, squares += length * length;
      length = 0;
    }
    const double mean = sum / runs, variance = squares / runs - mean * mean;
    if (runs < kLeastRuns || mean < kLeastLength || variance > kRegular * mean * (mean - 1)) continue;
    sensor.reach = static_cast<std::size_t>(std::ceil(kReach * mean));
    remark_ +=
        formatted("%sthe IMU's %s are each repeated in %.1f samples", remark_.empty() ? "" : "; ", sensor.name, mean);
  }
}

void HeldValues::push(const ImuSample& sample) {
  samples_.push_back(sample);
  if (!looked_ && sample.t_ns - samples_.front().t_ns >= kLook_ns) look();
}

/// Whether the sample after the next one's run is there, or there is none within reach.
bool HeldValues::isKnown(const Sensor& sensor) const {
  if (sensor.reach == 0 || next_ + sensor.reach < samples_.size()) return true;
  return samples_.back().*sensor.values != samples_[next_].*sensor.values;
}

/// A new value was measured up to one sample's interval before it first appears: half of it on average.
Eigen::Vector3d HeldValues::between(const Sensor& sensor) const {
  const Eigen::Vector3d& value = samples_[next_].*sensor.values;
  std::size_t first = next_, after = next_ + 1;
  while (first > 0 && samples_[first - 1].*sensor.values == value) --first;
  while (after < samples_.size() && samples_[after].*sensor.values == value) ++after;
  if (after == samples_.size() || after - first > sensor.reach) return value;
  const double s = (static_cast<double>(next_ - first) + 0.5) / static_cast<double>(after - first);
  return value + s * (samples_[after].*sensor.values - value);
}

std::optional<ImuSample> HeldValues::pop(bool at_end) {
  if (next_ == samples_.size()) return std::nullopt;
  if (at_end && !looked_) look();
  if (!looked_) return std::nullopt;
  ImuSample sample = samples_[next_];
  for (const Sensor& sensor : sensors_) {
    if (!at_end && !isKnown(sensor)) return std::nullopt;
    if (sensor.reach > 0) sample.*sensor.values = between(sensor);
  }
  ++next_;
  while (next_ > sensors_[0].reach + sensors_[1].reach) samples_.pop_front(), --next_;
  return sample;
}

}  // namespace lintel
