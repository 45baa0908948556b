// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/ImuAt.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

const Eigen::Vector3d kForce(0.4, -1.2, 9.7), kSlope(2, -3, 1), kRate(0.3, 0.5, -0.2);
constexpr std::int64_t kTime_ns = 1'600'000'000'123'456'789;

/// Every 5 ms from `first` to `last` samples away from the time in question.
ImuBatch samples(int first, int last) {
  ImuBatch batch;
  for (int k = first; k <= last; ++k)
    batch.push_back({kTime_ns + k * 5'000'000, kRate + 0.005 * k * kSlope, kForce, false});
  return batch;
}

void expectTrue(const std::optional<ImuAt>& imu) {
  ASSERT_TRUE(imu);
  EXPECT_LT((imu->gyro - kRate).norm(), 1e-12);
  EXPECT_LT((imu->gyro_slope - kSlope).norm(), 1e-9);
  EXPECT_LT((imu->accel - kForce).norm(), 1e-12);
}

TEST(ImuAt, IsExactWhereTheRateIsALine) {
  expectTrue(imuAt(samples(-20, 0), samples(0, 20)));
  expectTrue(imuAt(samples(-20, 0), ImuBatch{}));
  expectTrue(imuAt(ImuBatch{}, samples(0, 20)));
}

TEST(ImuAt, SamplesFartherAwayDoNotCount) {
  ImuBatch before = samples(-20, 0);
  for (std::size_t k = 0; k + 3 < before.size(); ++k) before[k].gyro.setConstant(9), before[k].accel.setConstant(99);
  expectTrue(imuAt(before, samples(0, 20)));
}

TEST(ImuAt, TheSampleAtTheTimeCountsOnce) {
  ImuBatch before = samples(-2, 0), after = samples(0, 2);
  const Eigen::Vector3d off(0.5, 0, 0);
  before.back().accel += off;
  after.front().accel += off;
  EXPECT_LT((imuAt(before, after)->accel - kForce - off / 5).norm(), 1e-12);
}

TEST(ImuAt, VibrationsAverageOut) {
  ImuBatch before = samples(-20, 0), after = samples(0, 20);
  const Eigen::Vector3d vibration(0, 0.1, 0);
  for (std::size_t k = 0; k < before.size(); ++k)
    before[before.size() - 1 - k].gyro += (k % 2 == 0 ? 1 : -1) * vibration;
  for (std::size_t k = 0; k < after.size(); ++k) after[k].gyro += (k % 2 == 0 ? 1 : -1) * vibration;
  EXPECT_LT((imuAt(before, after)->gyro - kRate).norm(), 0.3 * vibration.norm());
}

TEST(ImuAt, TooFewSamplesTellNothing) {
  EXPECT_FALSE(imuAt(ImuBatch{}, ImuBatch{}));
  EXPECT_FALSE(imuAt(nullptr, nullptr));
  EXPECT_FALSE(imuAt(samples(-1, 0), ImuBatch{}));
  EXPECT_FALSE(imuAt(samples(0, 0), ImuBatch{}));
}

TEST(MotionChange, IsWithoutBiasAndGravity) {
  const Eigen::Quaterniond R_w_b = expRotation({0.3, -0.4, 1.2});
  const Eigen::Vector3d acceleration_b(0.4, -1.2, 0.7), bias(0.1, -0.2, 0.05), gravity_w = gravityW(kGravity);
  const ImuAt imu{kRate, kSlope, acceleration_b + bias - R_w_b.conjugate() * gravity_w};
  const MotionChange change = motionChange(imu, bias, R_w_b, gravity_w);
  EXPECT_LT((change.acceleration_b - acceleration_b).norm(), 1e-12);
  EXPECT_EQ(change.angular_acceleration_b, kSlope);
}

}  // namespace
}  // namespace lintel
