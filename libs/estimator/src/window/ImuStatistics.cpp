// SPDX-License-Identifier: BSD-3-Clause
#include "window/ImuStatistics.h"

#include <cmath>

namespace lintel {

ImuStatistics imuStatistics(const SlidingWindow& window, std::size_t first) {
  ImuStatistics s;
  const auto each = [&](auto&& f) {
    for (std::size_t k = first; k < window.frames.size(); ++k)
      if (window.frames[k].imu)
        for (const ImuSample& sample : window.frames[k].imu->samples()) f(sample);
  };
  each([&](const ImuSample& x) { s.mean_gyro += x.gyro, s.mean_accel += x.accel, ++s.samples; });
  if (s.samples < 2) return s;
  const auto n = static_cast<double>(s.samples);
  s.mean_gyro /= n;
  s.mean_accel /= n;
  each([&](const ImuSample& x) {
    s.std_gyro += (x.gyro - s.mean_gyro).squaredNorm();
    s.std_accel += (x.accel - s.mean_accel).squaredNorm();
  });
  s.std_gyro = std::sqrt(s.std_gyro / n);
  s.std_accel = std::sqrt(s.std_accel / n);
  return s;
}

}  // namespace lintel
