// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/Manifolds.h"

#include <ceres/manifold_test_utils.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using namespace ceres;  // the matchers of manifold_test_utils.h expect it
constexpr double kTolerance = 1e-9;

/// A point of the manifold: a random tangent step from a fixed valid element.
Eigen::VectorXd pointOf(const StateManifold& manifold, const Eigen::VectorXd& origin, double size) {
  Eigen::VectorXd delta = size * Eigen::VectorXd::Random(manifold.TangentSize()), x(manifold.AmbientSize());
  manifold.Plus(origin.data(), delta.data(), x.data());
  return x;
}

void expectInvariants(const StateManifold& manifold, const Eigen::VectorXd& origin) {
  std::srand(7);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd x = pointOf(manifold, origin, 1.0), y = pointOf(manifold, origin, 1.0);
    const Eigen::VectorXd delta = 0.3 * Eigen::VectorXd::Random(manifold.TangentSize());
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, kTolerance);
  }
}

void expectDifferenceJacobian(const StateManifold& manifold, const Eigen::VectorXd& origin) {
  std::srand(11);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd x = pointOf(manifold, origin, 1.0), y = pointOf(manifold, origin, 1.0);
    RowMajorMatrix plus(manifold.AmbientSize(), manifold.TangentSize());
    manifold.PlusJacobian(y.data(), plus.data());
    const RowMajorMatrix analytic = manifold.differenceJacobian(y.data(), x.data()) * plus;
    RowMajorMatrix numeric(manifold.TangentSize(), manifold.TangentSize());
    const double eps = 1e-6;
    for (int k = 0; k < manifold.TangentSize(); ++k) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(manifold.TangentSize()), moved(manifold.AmbientSize());
      Eigen::VectorXd ahead(manifold.TangentSize()), behind(manifold.TangentSize());
      step[k] = eps;
      manifold.Plus(y.data(), step.data(), moved.data());
      manifold.Minus(moved.data(), x.data(), ahead.data());
      step[k] = -eps;
      manifold.Plus(y.data(), step.data(), moved.data());
      manifold.Minus(moved.data(), x.data(), behind.data());
      numeric.col(k) = (ahead - behind) / (2 * eps);
    }
    EXPECT_LT((analytic - numeric).norm(), 1e-7);
  }
}

const Eigen::VectorXd kPose = toBlock(Pose{expRotation({0.3, -0.2, 0.9}), {1, 2, 3}});
const Eigen::VectorXd kLine = toBlock(OrthonormalLine{expRotation({-0.4, 0.1, 0.5}), 0.7});

const Eigen::VectorXd kDirection = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();

TEST(DirectionManifold, Invariants) { expectInvariants(DirectionManifold(), kDirection); }
TEST(DirectionManifold, DifferenceJacobianFarFromTheLinearisation) {
  expectDifferenceJacobian(DirectionManifold(), kDirection);
}

TEST(PoseManifold, Invariants) { expectInvariants(PoseManifold(), kPose); }
TEST(LineManifold, Invariants) { expectInvariants(LineManifold(), kLine); }
TEST(PointManifold, Invariants) {
  expectInvariants(PointManifold(), Eigen::Vector4d(0.1, -0.5, 0.3, 0.2).normalized());
}
TEST(VectorManifold, Invariants) { expectInvariants(VectorManifold(4), Eigen::VectorXd::Ones(4)); }

TEST(PoseManifold, DifferenceJacobianHoldsFarApart) { expectDifferenceJacobian(PoseManifold(), kPose); }
TEST(LineManifold, DifferenceJacobianHoldsFarApart) { expectDifferenceJacobian(LineManifold(), kLine); }

TEST(PoseManifold, RotatesOnTheRight) {
  const Eigen::VectorXd x = toBlock(Pose{expRotation({0, 0, M_PI / 2}), {0, 0, 0}});
  const Eigen::VectorXd delta = (Eigen::VectorXd(6) << 1, 2, 3, 0.1, 0, 0).finished();
  Eigen::VectorXd y(7);
  PoseManifold().Plus(x.data(), delta.data(), y.data());
  const Pose result = poseFromBlock(y.data());
  EXPECT_TRUE(result.p.isApprox(Eigen::Vector3d(1, 2, 3)));
  // a turn about the body's x axis, which points along the world's y
  EXPECT_TRUE((result.q * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d(std::sin(0.1), 0, std::cos(0.1)), 1e-12));
}

TEST(LineManifold, PlusIsBartolisUpdate) {
  const OrthonormalLine line{expRotation({0.1, 0.2, 0.3}), 0.5};
  const Eigen::Vector4d delta(0.01, -0.02, 0.03, 0.05);
  const LineBlock x = toBlock(line);
  LineBlock y;
  LineManifold().Plus(x.data(), delta.data(), y.data());
  const OrthonormalLine moved = lineFromBlock(y.data());
  EXPECT_LT(moved.U.angularDistance(line.U * expRotation(delta.head<3>())), 1e-12);
  // W <- W R(dphi): the angle of a planar rotation adds
  EXPECT_DOUBLE_EQ(moved.phi, 0.55);
}

}  // namespace
}  // namespace lintel
