// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowNoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lintel {
namespace {

const ImuNoise kTrue{1.2e-3, 2e-5, 1.6e-2, 3e-3}, kGiven{2e-4, 2e-5, 2e-3, 3e-3};

/// Samples at rest with the true noise, 200 a second, in batches of 0.1 s.
class WindowNoiseTest : public testing::Test {
 protected:
  ImuBatch next() {
    const double gyro = kTrue.gyro_noise * std::sqrt(200), accel = kTrue.accel_noise * std::sqrt(200);
    ImuBatch batch = last_;
    while (batch.size() < 21) {
      ImuSample sample;
      sample.t_ns = 5'000'000LL * count_++;
      for (int axis = 0; axis < 3; ++axis) {
        sample.gyro[axis] = gyro * normal_(random_);
        sample.accel[axis] = (axis == 2 ? 9.81 : 0) + accel * normal_(random_);
      }
      batch.push_back(sample);
    }
    last_.assign(1, batch.back());
    return batch;
  }

  /// Frames every 0.1 s for two seconds, as the estimator makes them.
  SlidingWindow window(WindowNoise& noise) {
    SlidingWindow window{Rig()};
    window.frames.resize(1);
    for (int k = 0; k < 20; ++k) {
      const ImuBatch batch = next();
      noise.add(batch);
      WindowFrame frame;
      frame.id = static_cast<FrameId>(k) + 1;
      frame.imu = std::make_shared<Preintegration>(ImuBias{}, noise.now());
      frame.imu->append(batch);
      window.frames.push_back(frame);
    }
    return window;
  }

  std::mt19937 random_{5};
  std::normal_distribution<double> normal_;
  int count_ = 0;
  ImuBatch last_;
};

TEST_F(WindowNoiseTest, FramesBeforeWhiteNoiseIsKnownGetItAsWell) {
  WindowNoise noise(kGiven, {});
  SlidingWindow frames = window(noise);
  EXPECT_LT(frames.frames[1].imu->noise().gyro_noise, 0.5 * kTrue.gyro_noise) << "not known yet";
  noise.raise(frames);
  for (std::size_t k = 1; k < frames.frames.size(); ++k) {
    EXPECT_NEAR(frames.frames[k].imu->noise().gyro_noise, kTrue.gyro_noise, 0.15 * kTrue.gyro_noise) << k;
    EXPECT_NEAR(frames.frames[k].imu->noise().accel_noise, kTrue.accel_noise, 0.15 * kTrue.accel_noise) << k;
  }
}

TEST_F(WindowNoiseTest, ARightDataSheetRaisesNothing) {
  WindowNoise noise(kTrue, {});
  SlidingWindow frames = window(noise);
  std::vector<Preintegration::Matrix9> before;
  for (std::size_t k = 1; k < frames.frames.size(); ++k) before.push_back(frames.frames[k].imu->covariance());
  noise.raise(frames);
  for (std::size_t k = 1; k < frames.frames.size(); ++k)
    EXPECT_EQ(frames.frames[k].imu->covariance(), before[k - 1]) << k;
}

TEST_F(WindowNoiseTest, WithAScaleTheAccelerometersCorrelatedNoiseIsMeantAsGivenToo) {
  FactorParams params;
  WindowNoise measured(kGiven, params);
  params.accel_noise_scale = 2;
  WindowNoise given(kGiven, params);
  for (WindowNoise* noise : {&measured, &given}) noise->add(next());
  ImuBatch shaken = next();
  for (std::size_t i = 0; i < shaken.size(); ++i) shaken[i].accel.x() += i % 2 ? 3 : -3;
  for (WindowNoise* noise : {&measured, &given}) noise->add(shaken);
  EXPECT_GT(measured.now().accel_correlated, 0.02);
  EXPECT_EQ(given.now().accel_correlated, 0);
}

TEST_F(WindowNoiseTest, ADensityWithAScaleIsMeantAsGiven) {
  FactorParams params;
  params.gyro_noise_scale = 2;
  WindowNoise noise(kGiven, params);
  SlidingWindow frames = window(noise);
  noise.raise(frames);
  for (std::size_t k = 1; k < frames.frames.size(); ++k) {
    EXPECT_EQ(frames.frames[k].imu->noise().gyro_noise, 2 * kGiven.gyro_noise);
    EXPECT_GT(frames.frames[k].imu->noise().accel_noise, 0.8 * kTrue.accel_noise);
  }
}

}  // namespace
}  // namespace lintel
