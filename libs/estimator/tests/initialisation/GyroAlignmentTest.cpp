// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/GyroAlignment.h"

#include <gtest/gtest.h>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

/// A flight with a large constant gyro bias and otherwise perfect IMU.
TrackedFlight flightWithBias(double noise_px, double outliers = 0) {
  ImuSimulatorParams imu;
  imu.noise = false;
  imu.initial_gyro_bias = 0.06;
  imu.initial_accel_bias = 0;
  TrackSimulationParams tracks;
  tracks.duration_s = 4;
  tracks.point_noise_px = noise_px;
  tracks.outlier_share = outliers;
  return fly(imu, tracks);
}

TEST(GyroAlignment, FindsALargeBiasExactlyWithoutNoise) {
  const TrackedFlight flight = flightWithBias(0);
  ASSERT_GT(flight.truth(0).bias_gyro.norm(), 0.06);
  for (const std::size_t first : {0u, 20u, 40u}) {
    const GyroAlignment result = alignGyro(bufferOf(flight, first, 20));
    ASSERT_TRUE(result.ok);
    EXPECT_LT((result.bias_gyro - flight.truth(first).bias_gyro).norm(), 2e-4) << "from frame " << first;
  }
}

TEST(GyroAlignment, FindsItFromNoisyTracks) {
  const TrackedFlight flight = flightWithBias(0.5);
  for (const std::size_t first : {0u, 20u, 40u}) {
    const GyroAlignment result = alignGyro(bufferOf(flight, first, 20));
    ASSERT_TRUE(result.ok);
    EXPECT_LT((result.bias_gyro - flight.truth(first).bias_gyro).norm(), 0.01) << "from frame " << first;
  }
}

TEST(GyroAlignment, OutliersDoNotPullIt) {
  const TrackedFlight flight = flightWithBias(0.5, 0.05);
  const GyroAlignment result = alignGyro(bufferOf(flight, 0, 20));
  ASSERT_TRUE(result.ok);
  EXPECT_LT((result.bias_gyro - flight.truth(0).bias_gyro).norm(), 0.015);
}

TEST(GyroAlignment, TooFewPointsAreNotEnough) {
  TrackSimulationParams tracks;
  tracks.duration_s = 2;
  tracks.max_points_per_frame = 10;
  EXPECT_FALSE(alignGyro(bufferOf(fly(perfectImu(), tracks), 0, 20)).ok);
}

TEST(IntegratedRotations, AreTheTrueOnesRelativeToTheFirst) {
  TrackSimulationParams tracks;
  tracks.duration_s = 2;
  const TrackedFlight flight = fly(perfectImu(), tracks);
  const auto R_b0_bk = integratedRotations(bufferOf(flight, 0, 20));
  ASSERT_EQ(R_b0_bk.size(), 20u);
  for (std::size_t k = 0; k < R_b0_bk.size(); ++k) {
    const Eigen::Quaterniond truth = flight.truth(0).state.T_w_b.q.conjugate() * flight.truth(2 * k).state.T_w_b.q;
    EXPECT_LT(R_b0_bk[k].angularDistance(truth), 1e-4);
  }
}

}  // namespace
}  // namespace lintel
