// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/NoiseMeter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lintel {
namespace {

constexpr double kRate_hz = 200;
const ImuNoise kTrue{2e-4, 2e-5, 2e-3, 3e-3};

/// Batches of 0.1 s of a hand-held motion with white noise, vibration of an amplitude [m/s^2] from a time on, and a
/// walker's steps of another.
NoiseMeter measure(double duration_s, double vibration = 0, double vibrates_from_s = 0, double steps = 0) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto noise = [&](double density) -> Eigen::Vector3d {
    const double sigma = density * std::sqrt(kRate_hz);
    return sigma * Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  NoiseMeter meter;
  ImuBatch batch;
  for (int i = 0; i < duration_s * kRate_hz; ++i) {
    const double t = i / kRate_hz, shake = t >= vibrates_from_s ? vibration * std::sin(2 * M_PI * 83 * t) : 0,
                 step = steps * (std::sin(2 * M_PI * 2 * t) + 0.1 * std::sin(2 * M_PI * 4 * t + 1));
    ImuSample sample;
    sample.t_ns = std::llround(1e9 * t);
    sample.gyro =
        Eigen::Vector3d(0.3 * std::sin(3 * t), 0.2 * std::cos(4 * t), 0.02 + 0.1 * step) + noise(kTrue.gyro_noise);
    sample.accel =
        Eigen::Vector3d(0.5 * std::cos(4 * t), shake, 9.8 + std::sin(2 * t) + step) + noise(kTrue.accel_noise);
    batch.push_back(sample);
    if (batch.size() == 22) {
      meter.add(batch);
      batch.erase(batch.begin(), batch.end() - 2);  // the first and the last of a batch do not count
    }
  }
  return meter;
}

TEST(NoiseMeter, FindsWhiteNoiseUnderMotion) {
  const NoiseMeter meter = measure(3);
  ASSERT_TRUE(meter.now());
  EXPECT_NEAR(meter.now()->gyro_density, kTrue.gyro_noise, 0.1 * kTrue.gyro_noise);
  EXPECT_NEAR(meter.now()->accel_density, kTrue.accel_noise, 0.1 * kTrue.accel_noise);
}

TEST(NoiseMeter, NeedsAQuarterOfASecond) {
  EXPECT_FALSE(measure(0.2).now());
  EXPECT_TRUE(measure(0.5).now());
}

TEST(EffectiveNoise, KeepsWhatAgreesAndReplacesNonsense) {
  const NoiseMeter meter = measure(3);
  const ImuNoise kept = effectiveNoise(kTrue, meter);
  EXPECT_GE(kept.accel_noise, kTrue.accel_noise);
  EXPECT_LT(kept.accel_noise, 2 * kTrue.accel_noise);
  EXPECT_TRUE(noiseRemark(kTrue, meter).empty()) << noiseRemark(kTrue, meter);

  ImuNoise nonsense = kTrue;
  nonsense.accel_noise = 0.18;
  EXPECT_LT(effectiveNoise(nonsense, meter).accel_noise, 0.008);
  EXPECT_NE(noiseRemark(nonsense, meter).find("accelerometer_noise_density: 0.18"), std::string::npos)
      << noiseRemark(nonsense, meter);
  nonsense.gyro_noise = 1e-9;
  EXPECT_GE(effectiveNoise(nonsense, meter).gyro_noise, 5e-5);
}

TEST(NoiseMeter, WhiteNoiseIsKnownFromVibrationAndMotion) {
  const NoiseMeter white = measure(3);
  ASSERT_TRUE(white.whiteGyro());
  ASSERT_TRUE(white.whiteAccel());
  EXPECT_NEAR(*white.whiteGyro(), kTrue.gyro_noise, 0.15 * kTrue.gyro_noise);
  EXPECT_NEAR(*white.whiteAccel(), kTrue.accel_noise, 0.15 * kTrue.accel_noise);
  const NoiseMeter shaken = measure(3, 0.5);
  ASSERT_TRUE(shaken.whiteGyro());
  EXPECT_FALSE(shaken.whiteAccel()) << "vibration at 83 Hz has another density in means of four samples";
  EXPECT_FALSE(measure(0.4).whiteGyro()) << "it may be chance";
}

TEST(NoiseMeter, StepsDoNotHideWhiteNoise) {
  const NoiseMeter walking = measure(3, 0, 0, 4);
  ASSERT_TRUE(walking.whiteGyro());
  ASSERT_TRUE(walking.whiteAccel());
  EXPECT_NEAR(*walking.whiteGyro(), kTrue.gyro_noise, 0.15 * kTrue.gyro_noise);
  EXPECT_NEAR(*walking.whiteAccel(), kTrue.accel_noise, 0.15 * kTrue.accel_noise);
}

TEST(EffectiveNoise, ADataSheetThatUnderstatesWhiteNoiseIsCorrected) {
  const NoiseMeter meter = measure(3);
  ImuNoise understated = kTrue;
  understated.gyro_noise /= 4, understated.accel_noise /= 4;
  const ImuNoise taken = effectiveNoise(understated, meter), right = effectiveNoise(kTrue, meter);
  EXPECT_NEAR(taken.gyro_noise, right.gyro_noise, 0.2 * right.gyro_noise);
  EXPECT_NEAR(taken.accel_noise, right.accel_noise, 0.2 * right.accel_noise);
  EXPECT_NE(noiseRemark(understated, meter).find("gyroscope_noise_density: 5e-05"), std::string::npos)
      << noiseRemark(understated, meter);
}

TEST(EffectiveNoise, VibrationCountsAndTheQuietTimeIsRemembered) {
  const ImuNoise quiet = effectiveNoise(kTrue, measure(3));
  const NoiseMeter meter = measure(6, 2, 3);
  EXPECT_GT(effectiveNoise(kTrue, meter).accel_noise, 2 * quiet.accel_noise);
  EXPECT_NEAR(meter.quietest()->accel_density, kTrue.accel_noise, 0.2 * kTrue.accel_noise);
}

TEST(EffectiveNoise, ThreeTenthsOfTheGyroscopesVibrationStayAndLessOfTheAccelerometers) {
  NoiseMeter meter;  // 83 Hz, far above white noise, and no other motion
  ImuBatch batch;
  for (int i = 0; i < 200; ++i) {
    const double shake = std::sin(2 * M_PI * 83 * i / kRate_hz);
    batch.push_back({std::llround(1e9 * i / kRate_hz), {0, 0.2 * shake, 0}, {0, 3 * shake, 9.81}});
  }
  meter.add(batch);
  const ImuNoise noise = effectiveNoise(kTrue, meter);
  EXPECT_NEAR(noise.gyro_noise / meter.now()->gyro_density, 0.30, 0.01);
  EXPECT_NEAR(noise.accel_noise / meter.now()->accel_density, 0.15, 0.01);
}

TEST(EffectiveNoise, VibrationAndMotionMakeCorrelatedNoiseAndWhiteNoiseDoesNot) {
  const NoiseMeter still = measure(3), shaken = measure(3, 2);
  const double vibration = 0.15 * shaken.now()->accel_density, motion = 0.002 * shaken.now()->accel_motion;
  EXPECT_NEAR(effectiveNoise(kTrue, shaken).accel_correlated, 2.5 * std::hypot(vibration, motion), 1e-4);
  EXPECT_GT(effectiveNoise(kTrue, shaken).accel_correlated, 0.02);
  EXPECT_LT(effectiveNoise(kTrue, still).accel_correlated, 0.007) << "that of the motion";
  EXPECT_EQ(whiteNoise(kTrue, shaken).accel_correlated, 0);
  EXPECT_EQ(effectiveNoise(kTrue, NoiseMeter()).accel_correlated, 0) << "nothing is known yet";
}

TEST(EffectiveNoise, WithoutSamplesOnlyTheBoundsOfSensorsApply) {
  const ImuNoise noise = effectiveNoise({1e-4, 1e-9, 0.18, 1}, NoiseMeter());
  EXPECT_EQ(noise.gyro_noise, 1e-4);
  EXPECT_EQ(noise.gyro_walk, 1e-5);
  EXPECT_EQ(noise.accel_noise, 0.03);
  EXPECT_EQ(noise.accel_walk, 0.01);
}

}  // namespace
}  // namespace lintel
