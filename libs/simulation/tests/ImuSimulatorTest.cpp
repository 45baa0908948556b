// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/ImuSimulator.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/FigureTrajectory.h"

namespace lintel {
namespace {

ImuSimulatorParams exact() {
  ImuSimulatorParams params;
  params.noise = params.biases = false;
  return params;
}

// Independent of the trajectory's derivatives: dead reckoning from the first pose with the samples alone.
TEST(ImuSimulator, ExactSamplesIntegrateToThePoses) {
  const SimulatedImu imu = simulateImu(FigureTrajectory(), eurocRig(), exact(), 2001);
  Eigen::Quaterniond R_w_b = imu.truth[0].state.T_w_b.q;
  Eigen::Vector3d p = imu.truth[0].state.T_w_b.p, v = imu.truth[0].state.v_w_b;
  for (std::size_t k = 1; k < imu.samples.size(); ++k) {
    const ImuSample &a = imu.samples[k - 1], &b = imu.samples[k];
    const double dt = 1e-9 * static_cast<double>(b.t_ns - a.t_ns);
    const Eigen::Quaterniond R_next = R_w_b * expRotation(0.5 * dt * (a.gyro + b.gyro));
    const Eigen::Vector3d a0 = R_w_b * a.accel + gravityW(), a1 = R_next * b.accel + gravityW();
    p += dt * v + dt * dt * (a0 / 3 + a1 / 6);  // acceleration linear between the samples
    v += 0.5 * dt * (a0 + a1);
    R_w_b = R_next;
  }
  const KinematicState& last = imu.truth.back().state;  // after 10 s
  EXPECT_LT(logRotation(R_w_b.conjugate() * last.T_w_b.q).norm(), 2e-5);
  EXPECT_LT((v - last.v_w_b).norm(), 1e-3);
  EXPECT_LT((p - last.T_w_b.p).norm(), 3e-3);
}

TEST(ImuSimulator, AtRestItFeelsGravityUpwards) {
  FigureParams still;
  still.translation = still.rotation = 0;
  const SimulatedImu imu = simulateImu(FigureTrajectory(still), eurocRig(), exact(), 3);
  const Eigen::Vector3d up_b = imu.truth[0].state.T_w_b.q.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR((imu.samples[1].accel - 9.81 * up_b).norm(), 0, 1e-12);
  EXPECT_EQ(imu.samples[1].gyro.norm(), 0);
}

TEST(ImuSimulator, StampsAreExactAndStreamsEqualForASeed) {
  const SimulatedImu a = simulateImu(FigureTrajectory(), eurocRig(), {}, 400);
  const SimulatedImu b = simulateImu(FigureTrajectory(), eurocRig(), {}, 400);
  ImuSimulatorParams other;
  other.seed = 2;
  const SimulatedImu c = simulateImu(FigureTrajectory(), eurocRig(), other, 400);
  for (std::size_t k = 0; k < 400; ++k) {
    ASSERT_EQ(a.samples[k].t_ns, kSimulationStart_ns + 5'000'000 * static_cast<std::int64_t>(k));
    ASSERT_EQ(a.samples[k].gyro, b.samples[k].gyro);
    ASSERT_EQ(a.samples[k].accel, b.samples[k].accel);
  }
  EXPECT_NE(a.samples[0].gyro, c.samples[0].gyro);
}

TEST(ImuSimulator, NoiseAndWalkHaveTheRigsDensities) {
  const Rig rig = eurocRig();
  const std::size_t n = 40000;
  const SimulatedImu imu = simulateImu(FigureTrajectory(), rig, {}, n);
  double gyro = 0, accel = 0, gyro_walk = 0, accel_walk = 0;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const InertialTruth &t = imu.truth[k], &next = imu.truth[k + 1];
    const Eigen::Vector3d force = t.state.T_w_b.q.conjugate() * (t.state.a_w_b - gravityW());
    gyro += (imu.samples[k].gyro - t.state.omega_b - t.bias_gyro).squaredNorm();
    accel += (imu.samples[k].accel - force - t.bias_accel).squaredNorm();
    gyro_walk += (next.bias_gyro - t.bias_gyro).squaredNorm();
    accel_walk += (next.bias_accel - t.bias_accel).squaredNorm();
  }
  const auto density = [&](double sum, double factor) { return std::sqrt(sum / (3.0 * (n - 1)) * factor); };
  EXPECT_NEAR(density(gyro, 0.005) / rig.imu_noise.gyro_noise, 1, 0.02);
  EXPECT_NEAR(density(accel, 0.005) / rig.imu_noise.accel_noise, 1, 0.02);
  EXPECT_NEAR(density(gyro_walk, 200) / rig.imu_noise.gyro_walk, 1, 0.02);
  EXPECT_NEAR(density(accel_walk, 200) / rig.imu_noise.accel_walk, 1, 0.02);
  EXPECT_GT(imu.truth[0].bias_gyro.norm(), 1e-3);
  EXPECT_GT(imu.truth[0].bias_accel.norm(), 1e-2);
}

TEST(ImuSimulator, BiasesRollAwayAsFastAsAskedFor) {
  ImuSimulatorParams fast;
  fast.walk_scale = 10;
  const SimulatedImu usual = simulateImu(FigureTrajectory(), eurocRig(), {}, 2000);
  const SimulatedImu rolling = simulateImu(FigureTrajectory(), eurocRig(), fast, 2000);
  const auto drift = [](const SimulatedImu& imu) -> Eigen::Vector3d {
    return imu.truth.back().bias_gyro - imu.truth.front().bias_gyro;
  };
  EXPECT_EQ(usual.truth[0].bias_gyro, rolling.truth[0].bias_gyro);
  EXPECT_NEAR((drift(rolling) - 10 * drift(usual)).norm(), 0, 1e-12);
  EXPECT_EQ(usual.samples[0].gyro, rolling.samples[0].gyro);
}

TEST(ImuSimulator, RatesThatDoNotFitAreRefused) {
  Rig rig = eurocRig();
  rig.imu_rate_hz = 210;
  EXPECT_THROW(imuPerFrame(rig), std::invalid_argument);
  rig.imu_rate_hz = 0;
  EXPECT_THROW(imuStep_ns(rig), std::invalid_argument);
  EXPECT_EQ(imuPerFrame(eurocRig()), 10);
}

}  // namespace
}  // namespace lintel
