// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/PriorFactors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "TestFactors.h"

namespace lintel {
namespace {

using testing::expectGradients, testing::kLineManifold, testing::kPoseManifold, testing::Scene;

TEST(PriorFactor, GradientsFarFromTheLinearisation) {
  std::srand(3);
  const Scene s;
  const LineBlock line0 = toBlock(OrthonormalLine{expRotation({0.3, 0.2, 0.1}), 0.4});
  const LineBlock line = toBlock(OrthonormalLine{expRotation({0.1, 0.4, -0.2}), 0.6});
  PriorFactor factor({{std::make_shared<PoseManifold>(), s.T_w_bi}, {std::make_shared<LineManifold>(), line0}},
                     Eigen::MatrixXd::Random(8, 10), Eigen::VectorXd::Random(8));
  expectGradients(factor, {&kPoseManifold, &kLineManifold}, {s.T_w_bj.data(), line.data()});
}

TEST(BlockPrior, WeighsBySigmaAndLeavesInfiniteOnesFree) {
  const Eigen::Vector3d x0(1, 2, 3), x(2, 4, 6);
  const auto prior = makeBlockPrior(std::make_shared<VectorManifold>(3), x0,
                                    Eigen::Vector3d(0.5, std::numeric_limits<double>::infinity(), 3));
  const double* blocks[] = {x.data()};
  Eigen::Vector3d r;
  ASSERT_TRUE(prior->Evaluate(blocks, r.data(), nullptr));
  EXPECT_TRUE(r.isApprox(Eigen::Vector3d(2, 0, 1)));
}

/// A prior over two poses, a motion, the extrinsics and a point, away from its linearisation, with A = N (I - G G^+):
/// blind to the gauge where it was linearised, as marginalisation leaves it.
struct GaugeFreePrior {
  std::vector<Pose> poses_0{{expRotation({0.1, -0.2, 0.3}), {0.5, 0.2, -0.1}},
                            {expRotation({0.2, 0.1, -1.3}), {2, -1, 0.4}}};
  MotionBlock motion_0 = MotionBlock::LinSpaced(-0.4, 0.5);
  PoseBlock extrinsics_0 = toBlock(Pose{expRotation({0.02, 0.01, 1.55}), {-0.02, -0.06, 0.01}});
  Eigen::Vector3d origin_w{0.4, -0.3, 0.2};
  PointBlock point_0 = PointBlock(1.2, -0.5, 3, 0.8).normalized();
  std::unique_ptr<PriorFactor> factor;

  Eigen::Vector3d positionOf(const PointBlock& point) const { return origin_w + point.head<3>() / point[3]; }

  GaugeFreePrior() {
    const auto pose = std::make_shared<PoseManifold>();
    std::vector<PriorBlock> blocks{{pose, toBlock(poses_0[0]), GaugeAction::kPose},
                                   {pose, toBlock(poses_0[1]), GaugeAction::kPose},
                                   {std::make_shared<VectorManifold>(kMotionSize), motion_0, GaugeAction::kMotion},
                                   {pose, extrinsics_0},
                                   {std::make_shared<PointManifold>(), point_0, GaugeAction::kPoint, origin_w}};
    constexpr int kPointAt = 3 * kPoseTangent + kMotionSize, n = kPointAt + kPointTangent;
    Eigen::MatrixXd A(8, n), G = Eigen::MatrixXd::Zero(n, 4);
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < n; ++k) A(i, k) = std::sin(1 + 3.7 * i + 1.3 * k * k);
    for (int k = 0; k < 2; ++k) {
      const Eigen::Index at = Eigen::Index{kPoseTangent} * k;
      G.block<3, 3>(at, 0).setIdentity();
      G.block<3, 1>(at, 3) = Eigen::Vector3d::UnitZ().cross(poses_0[k].p);
      G.block<3, 1>(at + 3, 3) = poses_0[k].q.conjugate() * Eigen::Vector3d::UnitZ();
    }
    G.block<3, 1>(12, 3) = Eigen::Vector3d::UnitZ().cross(velocityOf(motion_0.data()));
    Eigen::Matrix<double, kPointSize, 4> moved = Eigen::Matrix<double, kPointSize, 4>::Zero();
    moved.topLeftCorner<3, 3>() = point_0[3] * Eigen::Matrix3d::Identity();
    moved.topRightCorner<3, 1>() = point_0[3] * Eigen::Vector3d::UnitZ().cross(positionOf(point_0));
    RowMajorMatrix minus(kPointTangent, kPointSize);
    PointManifold().MinusJacobian(point_0.data(), minus.data());
    G.block<3, 4>(kPointAt, 0) = minus * moved;
    A -= A * G * Eigen::Matrix4d(G.transpose() * G).inverse() * G.transpose();
    factor = std::make_unique<PriorFactor>(std::move(blocks), A, Eigen::VectorXd::LinSpaced(8, -1, 1));
  }
};

struct PriorState {
  PoseBlock first, second, extrinsics;
  MotionBlock motion;
  PointBlock point;
  std::vector<const double*> blocks() const {
    return {first.data(), second.data(), motion.data(), extrinsics.data(), point.data()};
  }
};

/// The linearisation point moved by much (the world) and by little (each block by itself).
PriorState displaced(const GaugeFreePrior& prior, const Pose& world, double little) {
  const auto moved = [&](const Pose& pose, double by) {
    return toBlock(world * pose *
                   Pose{expRotation(by * Eigen::Vector3d(0.3, -0.2, 0.5)), by * Eigen::Vector3d(1, 2, -1)});
  };
  PriorState state{moved(prior.poses_0[0], little), moved(prior.poses_0[1], -little), prior.extrinsics_0,
                   prior.motion_0, prior.point_0};
  const Eigen::Vector3d p_w = world * (prior.positionOf(prior.point_0) + little * Eigen::Vector3d(1, -1, 2));
  state.point.head<3>() = state.point[3] * (p_w - prior.origin_w);
  state.point.normalize();
  state.motion.segment<3>(kVelocityAt) = world.q * (velocityOf(prior.motion_0.data()) + Eigen::Vector3d(little, 0, 0));
  state.motion[kBiasGyroAt] += little;
  return state;
}

const Pose kOtherWorld{Eigen::Quaterniond(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ())), {30, -20, 5}};

TEST(PriorFactor, DoesNotChangeWhenTheWorldMoves) {
  const GaugeFreePrior prior;
  const PriorState here = displaced(prior, Pose{}, 0.05), there = displaced(prior, kOtherWorld, 0.05);
  Eigen::VectorXd r_here(8), r_there(8), r_0(8);
  ASSERT_TRUE(prior.factor->Evaluate(here.blocks().data(), r_here.data(), nullptr));
  ASSERT_TRUE(prior.factor->Evaluate(there.blocks().data(), r_there.data(), nullptr));
  EXPECT_LT((r_here - r_there).norm(), 1e-9);
  const PriorState at_0 = displaced(prior, Pose{}, 0);
  ASSERT_TRUE(prior.factor->Evaluate(at_0.blocks().data(), r_0.data(), nullptr));
  EXPECT_GT((r_here - r_0).norm(), 0.01) << "it is not blind to the rest";
}

TEST(PriorFactor, GradientsInAnotherWorld) {
  const GaugeFreePrior prior;
  const PointManifold point;
  for (const double little : {0.0, 0.05, 0.4}) {
    const PriorState state = displaced(prior, kOtherWorld, little);
    expectGradients(*prior.factor, {&kPoseManifold, &kPoseManifold, nullptr, &kPoseManifold, &point}, state.blocks(),
                    1e-5);
  }
}

TEST(PriorFactor, PlainKnowledgeOfAPoseIsAbsolute) {
  const auto prior =
      makeBlockPrior(std::make_shared<PoseManifold>(), toBlock(Pose{}), Eigen::VectorXd::Constant(6, 0.1));
  const PoseBlock moved = toBlock(Pose{Eigen::Quaterniond::Identity(), {1, 0, 0}});
  const double* blocks[] = {moved.data()};
  Eigen::VectorXd r(6);
  ASSERT_TRUE(prior->Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r[0], 10, 1e-12);
  EXPECT_LT(prior->anchor(), 0);
}

}  // namespace
}  // namespace lintel
