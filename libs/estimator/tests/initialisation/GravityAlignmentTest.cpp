// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/GravityAlignment.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "TestWindow.h"
#include "lintel/geometry/Frames.h"

namespace lintel {
namespace {

using namespace test;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

double costOf(const Matrix6& A, const Vector6& b, const Vector6& x) { return x.dot(A * x) - 2 * b.dot(x); }

/// The least cost over a fine grid of directions of gravity, velocity solved for each.
double bruteForce(const Matrix6& A, const Vector6& b) {
  const Eigen::Matrix3d Avv_inverse = A.topLeftCorner<3, 3>().inverse();
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 360; ++i)
    for (int j = 0; j < 720; ++j) {
      const double polar = M_PI * i / 360, azimuth = M_PI * j / 360;
      Vector6 x;
      x.tail<3>() = kGravity * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                               std::cos(polar));
      x.head<3>() = Avv_inverse * (b.head<3>() - A.topRightCorner<3, 3>() * x.tail<3>());
      best = std::min(best, costOf(A, b, x));
    }
  return best;
}

TEST(SolveWithGravityNorm, IsAsGoodAsBruteForce) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  for (int trial = 0; trial < 6; ++trial) {
    Eigen::Matrix<double, 9, 6> J;
    for (double& v : J.reshaped()) v = gauss(random);
    J.col(3) *= 0.2;  // a direction of gravity that is seen less well
    const Matrix6 A = J.transpose() * J;
    Vector6 b;
    for (double& v : b) v = 10 * gauss(random);
    const Vector6 x = solveWithGravityNorm(A, b, kGravity);
    EXPECT_NEAR(x.tail<3>().norm(), kGravity, 1e-8);
    const double brute = bruteForce(A, b), cost = costOf(A, b, x);
    EXPECT_LE(cost, brute + 1e-9 * std::abs(brute)) << "trial " << trial;
    EXPECT_GE(cost, brute - 1e-3 * A.norm() * kGravity * kGravity) << "trial " << trial;
  }
}

TEST(SolveWithGravityNorm, FindsWhatTheSystemWasMadeOf) {
  const Vector6 truth = (Vector6() << 0.5, -1, 0.2, 0, 6, -std::sqrt(kGravity * kGravity - 36)).finished();
  Matrix6 A = Vector6(1, 2, 3, 4, 5, 6).asDiagonal();
  A(0, 4) = A(4, 0) = 0.7;
  EXPECT_LT((solveWithGravityNorm(A, A * truth, kGravity) - truth).norm(), 1e-6);
}

/// Errors of gravity's direction [rad] and of the velocity [m/s] for a buffer from frame `first`.
struct AlignmentError {
  double gravity_rad = 0, velocity_m_s = 0;
};

AlignmentError errorOf(const GravityAlignment& result, const InertialTruth& truth) {
  const Eigen::Vector3d g_b = truth.state.T_w_b.q.conjugate() * gravityW();
  return {std::atan2(g_b.cross(result.g_b0).norm(), g_b.dot(result.g_b0)),
          (result.v_b0 - truth.state.T_w_b.q.conjugate() * truth.state.v_w_b).norm()};
}

TEST(GravityAlignment, FindsVelocityAndGravityOfAPerfectFlight) {
  TrackSimulationParams tracks;
  tracks.duration_s = 5;
  const TrackedFlight flight = fly(perfectImu(), tracks);
  for (const std::size_t first : {0u, 30u, 60u}) {
    const GravityAlignment result = alignGravity(bufferOf(flight, first, 20));
    ASSERT_TRUE(result.ok);
    const AlignmentError error = errorOf(result, flight.truth(first));
    EXPECT_LT(error.gravity_rad, 2e-3) << "from frame " << first;
    EXPECT_LT(error.velocity_m_s, 0.01) << "from frame " << first;
    ASSERT_EQ(result.p_b0_bk.size(), 20u);
    const Pose T_b0_w = flight.truth(first).state.T_w_b.inverse();
    EXPECT_LT((result.p_b0_bk.back() - T_b0_w * flight.truth(first + 38).state.T_w_b.p).norm(), 0.02);
  }
}

TEST(GravityAlignment, NoiseAndOutliersCostLittle) {
  TrackSimulationParams tracks;
  tracks.duration_s = 5;
  tracks.point_noise_px = 0.5;
  tracks.outlier_share = 0.03;
  ImuSimulatorParams imu;
  imu.biases = false;
  const TrackedFlight flight = fly(imu, tracks);
  for (const std::size_t first : {0u, 30u, 60u}) {
    const GravityAlignment result = alignGravity(bufferOf(flight, first, 20));
    ASSERT_TRUE(result.ok);
    const AlignmentError error = errorOf(result, flight.truth(first));
    EXPECT_LT(error.gravity_rad, 0.05) << "from frame " << first;
    EXPECT_LT(error.velocity_m_s, 0.3) << "from frame " << first;
  }
}

TEST(GravityAlignment, TooFewPointsAreNotEnough) {
  TrackSimulationParams tracks;
  tracks.duration_s = 2;
  tracks.max_points_per_frame = 8;
  EXPECT_FALSE(alignGravity(bufferOf(fly(perfectImu(), tracks), 0, 20)).ok);
}

}  // namespace
}  // namespace lintel
