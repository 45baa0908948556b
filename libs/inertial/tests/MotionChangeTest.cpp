// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/MotionChange.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

const Eigen::Vector3d kAcceleration_b(0.4, -1.2, 0.7), kAngular_b(2, -3, 1), kRate_b(0.3, 0.5, -0.2);
const ImuBias kBias{{0.01, 0.02, -0.03}, {0.1, -0.2, 0.05}};
const Eigen::Quaterniond kAttitude = expRotation({0.3, -0.4, 1.2});
constexpr std::int64_t kTime_ns = 1'600'000'000'123'456'789;

/// Every 5 ms from `first` to `last` samples away from the time in question.
ImuBatch samples(int first, int last) {
  ImuBatch batch;
  for (int k = first; k <= last; ++k)
    batch.push_back({kTime_ns + k * 5'000'000, kRate_b + kBias.gyro + 0.005 * k * kAngular_b,
                     kAcceleration_b + kBias.accel - kAttitude.conjugate() * gravityW(kGravity), false});
  return batch;
}

void expectTrue(const MotionChange& change) {
  EXPECT_LT((change.acceleration_b - kAcceleration_b).norm(), 1e-9);
  EXPECT_LT((change.angular_acceleration_b - kAngular_b).norm(), 1e-9);
}

MotionChange changeOf(const ImuBatch& before, const ImuBatch& after) {
  return motionChange(before, after, 0.012, kBias, kAttitude, gravityW(kGravity));
}

TEST(MotionChange, IsThatOfSteadyAccelerations) {
  expectTrue(changeOf(samples(-20, 0), samples(0, 20)));
  expectTrue(changeOf(samples(-20, 0), {}));
  expectTrue(changeOf({}, samples(0, 20)));
}

TEST(MotionChange, SamplesFartherAwayDoNotCount) {
  ImuBatch before = samples(-20, 0);
  for (std::size_t k = 0; k + 3 < before.size(); ++k) before[k].gyro.setConstant(9), before[k].accel.setConstant(99);
  expectTrue(changeOf(before, samples(0, 20)));
}

TEST(MotionChange, TheSampleAtTheTimeCountsOnce) {
  ImuBatch before = samples(-2, 0), after = samples(0, 2);
  const Eigen::Vector3d off(0.5, 0, 0);
  before.back().accel += off;
  after.front().accel += off;
  EXPECT_LT((changeOf(before, after).acceleration_b - kAcceleration_b - off / 5).norm(), 1e-9);
}

TEST(MotionChange, TooFewSamplesTellNothing) {
  for (const MotionChange& change : {changeOf({}, {}), changeOf(samples(-1, 0), {}), changeOf(samples(0, 0), {})}) {
    EXPECT_EQ(change.acceleration_b, Eigen::Vector3d::Zero());
    EXPECT_EQ(change.angular_acceleration_b, Eigen::Vector3d::Zero());
  }
}

}  // namespace
}  // namespace lintel
