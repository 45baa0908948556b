// SPDX-License-Identifier: BSD-3-Clause
#include "GyroPrediction.h"

#include <gtest/gtest.h>

#include "TestImages.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr std::int64_t kGyroStep_ns = 50'000'000;

TEST(GyroPrediction, turnsTheCameraThroughTheExtrinsics) {
  const Rig rig = testing::testRig();
  GyroPrediction gyro(rig, 0.1);
  const Eigen::Vector3d rate_b(0.4, -0.6, 0.8);
  ASSERT_TRUE(gyro.predict(testing::constantRate(0, kGyroStep_ns, rate_b), 0.05));
  const Eigen::Quaterniond R_w_b1 = expRotation(rate_b * 0.05);
  const Eigen::Quaterniond expected = (R_w_b1 * rig.T_b_c.q).conjugate() * rig.T_b_c.q;
  EXPECT_LT(expected.angularDistance(gyro.R_c1_c0()), 1e-9);
}

TEST(GyroPrediction, learnsTheBias) {
  const Rig rig = testing::testRig();
  GyroPrediction gyro(rig, 0.1);
  const Eigen::Vector3d rate_b(0.1, 0.3, -0.2), bias(0.08, -0.05, 0.03);
  const Eigen::Quaterniond truth = (expRotation(rate_b * 0.05) * rig.T_b_c.q).conjugate() * rig.T_b_c.q;
  for (int i = 0; i < 40; ++i) {
    gyro.predict(testing::constantRate(i * kGyroStep_ns, (i + 1) * kGyroStep_ns, rate_b + bias), 0.05);
    gyro.correct(logRotation(truth * gyro.R_c1_c0().conjugate()), Eigen::Matrix3d::Identity() / (3e-4 * 3e-4));
  }
  EXPECT_LT((gyro.bias() - bias).norm(), 2e-3);
}

/// A hand that shakes, in images that show the world 45 ms before their stamps: what they miss of the gyroscope's turns
/// is no bias.
TEST(GyroPrediction, learnsHowLateImagesAre) {
  const Rig rig = testing::testRig();
  GyroPrediction gyro(rig, 0.1);
  constexpr double kDelay_s = -0.045;
  const auto R_w_b = [](double t_s) {
    return expRotation({0.04 * std::sin(6 * t_s), 0.05 * std::sin(4 * t_s + 1), 0.03 * std::sin(5 * t_s)});
  };
  const auto batch = [&](double from_s, double to_s) {
    ImuBatch imu;
    for (double t_s = from_s; t_s < to_s + 1e-9; t_s += 0.005)
      imu.push_back(
          {std::llround(1e9 * t_s), logRotation(R_w_b(t_s - 1e-4).conjugate() * R_w_b(t_s + 1e-4)) / 2e-4, {}});
    return imu;
  };
  double largest = 0;  // in the second half
  for (int i = 1; i <= 40; ++i) {
    const double from_s = 0.05 * i, to_s = from_s + 0.05;
    const Eigen::Quaterniond truth =
        (R_w_b(to_s + kDelay_s) * rig.T_b_c.q).conjugate() * (R_w_b(from_s + kDelay_s) * rig.T_b_c.q);
    gyro.predict(batch(from_s, to_s), 0.05);
    if (i > 20) largest = std::max(largest, gyro.R_c1_c0().angularDistance(truth));
    gyro.correct(logRotation(truth * gyro.R_c1_c0().conjugate()), Eigen::Matrix3d::Identity() / (3e-4 * 3e-4));
  }
  EXPECT_LT(largest, 1e-3) << "4e-3 when they are taken to be as late as they say";
  EXPECT_LT(gyro.bias().norm(), 2e-3);
}

TEST(GyroPrediction, goesOnTurningWithoutGyro) {
  GyroPrediction gyro(testing::testRig(), 0.1);
  gyro.predict(testing::constantRate(0, kGyroStep_ns, {0, 0, 1}), 0.05);
  const Eigen::Quaterniond first = gyro.R_c1_c0();
  EXPECT_FALSE(gyro.predict({}, 0.1));
  EXPECT_LT((first * first).angularDistance(gyro.R_c1_c0()), 1e-9);
}

TEST(GyroPrediction, saysWhenAStepIsLongerThanTheOneBefore) {
  GyroPrediction gyro(testing::testRig(), 0.1);
  gyro.predict({}, 0.05);
  EXPECT_EQ(gyro.stepRatio(), 1);
  gyro.predict({}, 0.06);
  EXPECT_EQ(gyro.stepRatio(), 1) << "stamps may be off";
  gyro.predict({}, 0.18);
  EXPECT_FLOAT_EQ(gyro.stepRatio(), 3);
  gyro.predict({}, 0.06);
  EXPECT_FLOAT_EQ(gyro.stepRatio(), 1.0f / 3);
}

}  // namespace
}  // namespace lintel
