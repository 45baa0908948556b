// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"

namespace lintel {

/// What the samples of an IMU show over a short span.
struct SampledNoise {
  double gyro_density = 0;   ///< white density that the fastest changes from sample to sample have [rad/s/sqrt(Hz)]
  double accel_density = 0;  ///< the same [m/s^2/sqrt(Hz)]; vibration counts in both
  double gyro_motion = 0;    ///< standard deviation of the rate over the span, norm over the axes [rad/s]
  double accel_motion = 0;   ///< of the specific force [m/s^2]
};

/// Measures the noise of an IMU by its own samples: the deviation of a sample from the line through its neighbours has
/// no gravity and next to no motion in it, only noise and vibration. White noise of standard deviation s deviates by
/// s * sqrt(1 + a^2 + b^2), a and b the neighbours' shares.
class NoiseMeter {
 public:
  /// Samples between two frames, both ends included (core/Frame.h); batches in ascending time.
  void add(const ImuBatch& batch);

  /// Over the last two seconds; empty until there is a quarter of a second.
  const std::optional<SampledNoise>& now() const { return now_; }

  /// The smallest densities that were measured so far.
  const std::optional<SampledNoise>& quietest() const { return quietest_; }

  /// The smallest densities while the noise was white: single samples and means of two and of four show the same. The
  /// accelerometer's needs a white gyroscope as well: a flying vehicle's vibration may look white in it. Empty until
  /// that has lasted for half a second.
  const std::optional<double>& whiteGyro() const { return white_gyro_; }
  const std::optional<double>& whiteAccel() const { return white_accel_; }

 private:
  void measure();
  void measureWhite(double period_s);

  std::deque<ImuSample> samples_;  ///< as recorded: without those interpolated at the frames' times
  std::optional<SampledNoise> now_, quietest_;
  std::int64_t gyro_white_since_ns_ = -1, accel_white_since_ns_ = -1;  ///< -1: they are not
  std::optional<double> white_gyro_, white_accel_;
};

/// The densities to integrate with, for what a data sheet says and what the samples show:
/// - white noise: as given, where it lies between what sensors can do and three times what was measured at the
///   quietest (a filter in the sensor may hide as much); as measured where it is white and more than given;
/// - vibration: periodic, so that most of it integrates to nothing; 0.3 of the gyroscope's and 0.15 of the
///   accelerometer's stay (by what samples of flights are wrong by, doc/benchmarks/imu_noise.md);
/// - what calibration leaves in scale and alignment of a MEMS sensor's axes, 0.2 % of the motion, lasting a second;
/// - the accelerometer's correlated noise: 2.5 sqrt(Hz) times the density of these two (measured as the shares were).
/// Walks are given bounds of what sensors do.
ImuNoise effectiveNoise(const ImuNoise& given, const NoiseMeter& meter);

/// The white part of it, which is always there.
ImuNoise whiteNoise(const ImuNoise& given, const NoiseMeter& meter);

/// How far a given density is from what was measured, in words; empty where it is plausible.
std::string noiseRemark(const ImuNoise& given, const NoiseMeter& meter);

}  // namespace lintel
