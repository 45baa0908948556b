// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowNoise.h"

namespace lintel {

void WindowNoise::raise(SlidingWindow& window) const {
  const ImuNoise least = chosen(whiteNoise(given_, meter_));
  for (WindowFrame& frame : window.frames)
    if (frame.imu) frame.imu->raiseNoise(least);
}

ImuNoise WindowNoise::chosen(const ImuNoise& measured) const {
  const auto one = [](double given, double seen, double scale) { return scale == 1 ? seen : scale * given; };
  return {one(given_.gyro_noise, measured.gyro_noise, params_.gyro_noise_scale),
          one(given_.gyro_walk, measured.gyro_walk, params_.gyro_walk_scale),
          one(given_.accel_noise, measured.accel_noise, params_.accel_noise_scale),
          one(given_.accel_walk, measured.accel_walk, params_.accel_walk_scale),
          one(given_.accel_correlated, measured.accel_correlated, params_.accel_noise_scale)};
}

}  // namespace lintel
