// SPDX-License-Identifier: BSD-3-Clause
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lintel/factors/ImuFactor.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/Manifolds.h"
#include "lintel/factors/PointFactor.h"
#include "lintel/factors/PriorFactors.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/factors/VanishingFactor.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

const PoseManifold kPoseManifold;
const LineManifold kLineManifold;

/// Analytic against numeric Jacobians in the tangent spaces.
void expectGradients(const ceres::CostFunction& cost, const std::vector<const ceres::Manifold*>& manifolds,
                     const std::vector<const double*>& blocks, double tolerance = 1e-6) {
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-5;  // the default 1e-2 jumps over a line's own extent
  ceres::GradientChecker checker(&cost, &manifolds, options);
  ceres::GradientChecker::ProbeResults results;
  checker.Probe(blocks.data(), tolerance, &results);
  ASSERT_TRUE(results.return_value);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    // relative to the block's largest entry: a component that is exactly zero has no relative error of its own
    const Eigen::MatrixXd difference = results.local_jacobians[i] - results.local_numeric_jacobians[i];
    const double scale = std::max(1e-3, results.local_numeric_jacobians[i].cwiseAbs().maxCoeff());
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), tolerance * scale) << "block " << i << "\n" << results.error_log;
  }
}

NormalisedObservation observation(double x, double y) {
  NormalisedObservation o;
  o.position = {x, y};
  o.correction_jacobian = 0.01 * ObservationJacobian::Ones();
  o.correction_jacobian(0, 2) = -0.02;
  o.correction_jacobian.col(kTimeOffsetAt).setZero();
  return o;
}

struct Scene {
  PoseBlock T_w_bi = toBlock(Pose{expRotation({0.1, -0.2, 0.3}), {0.5, 0.2, -0.1}});
  PoseBlock T_w_bj = toBlock(Pose{expRotation({0.15, -0.1, 0.4}), {0.9, 0.3, 0.1}});
  PoseBlock T_b_c = toBlock(Pose{expRotation({0.02, 0.01, 1.55}), {-0.02, -0.06, 0.01}});
  CorrectionBlock correction = 0.01 * CorrectionBlock::Ones();
};

PinholeRadtan eurocCamera() { return {752, 480, 458.654, 457.296, 367.215, 248.375, -0.28, 0.074, 2e-4, 1.8e-5}; }

const FrameMotion kMotion{{0.5, -0.3, 0.8}, {0.3, -0.6, 0.2}};

TEST(PointFactor, HandComputed) {
  // Camera j stands 1 m to the right of the origin; the point is 2 m ahead of the origin, thus at x/z = -0.5.
  const PoseBlock right = toBlock(Pose{Eigen::Quaterniond::Identity(), {1, 0, 0}}), identity = toBlock(Pose{});
  const CorrectionBlock zero = CorrectionBlock::Zero();
  const PointBlock point(0, 0, 2, 1);
  const PinholeRadtan camera{640, 480, 100, 100, 320, 240, 0, 0, 0, 0};
  PointFactor factor({280, 250}, camera, {}, Eigen::Vector3d::Zero(), 2);
  const double* blocks[] = {right.data(), identity.data(), zero.data(), point.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r.x(), -5, 1e-12);  // seen at (270, 240)
  EXPECT_NEAR(r.y(), -5, 1e-12);
}

TEST(PointFactor, TimeOffsetMovesTheCamera) {
  // At 2 m/s to the right an offset of 50 ms is 0.1 m: 5 px at 2 m and a focal length of 100 px.
  const PoseBlock identity = toBlock(Pose{});
  CorrectionBlock correction = CorrectionBlock::Zero();
  correction[kTimeOffsetAt] = 0.05;
  const PointBlock point(0, 0, 2, 1);
  const PinholeRadtan camera{640, 480, 100, 100, 320, 240, 0, 0, 0, 0};
  PointFactor factor({320, 240}, camera, {{2, 0, 0}, {0, 0, 0}}, Eigen::Vector3d::Zero(), 1);
  const double* blocks[] = {identity.data(), identity.data(), correction.data(), point.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r.x(), -5, 1e-12);
  EXPECT_NEAR(r.y(), 0, 1e-12);
}

TEST(PointFactor, GradientsFromNearToInfinity) {
  const Scene s;
  const PointManifold manifold;
  const CorrectionBlock correction = (CorrectionBlock() << 1, -1, 0.5, 2, 0.01, -0.003, 0.004).finished();
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  for (const double inverse_depth : {0.0, 0.02, 0.3, 2.0}) {
    PointBlock point;
    point << T_w_c.q * Eigen::Vector3d(0.2, -0.1, 1), inverse_depth;
    point.normalize();
    PointFactor factor({350, 260}, eurocCamera(), kMotion, T_w_c.p + Eigen::Vector3d(0.1, 0, 0), 0.7);
    expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &manifold},
                    {s.T_w_bi.data(), s.T_b_c.data(), correction.data(), point.data()});
  }
}

TEST(LineFactor, HandComputed) {
  // A line parallel to x, 4 m ahead and 2 m down: seen as y = 0.5. Its moment is taken about (0, 0, 3).
  const Eigen::Vector3d origin(0, 0, 3);
  const LineBlock line = toBlock(toOrthonormal(movedOrigin(lineThrough({-1, 2, 4}, {1, 2, 4}), origin)));
  const PoseBlock identity = toBlock(Pose{});
  const CorrectionBlock zero = CorrectionBlock::Zero();
  LineFactor factor(observation(-0.3, 0.5), observation(0.3, 0.6), {}, origin, 100);
  const double* blocks[] = {identity.data(), identity.data(), zero.data(), line.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(std::abs(r[0]), 0, 1e-9);
  EXPECT_NEAR(std::abs(r[1]), 10, 1e-9);
}

TEST(LineFactor, GradientsFromFarToNearlyThroughTheCameraAndTheOrigin) {
  const Scene s;
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  for (const double distance : {0.05, 0.5, 3.0, 50.0}) {
    const Eigen::Vector3d p0 = T_w_c * Eigen::Vector3d(0.1 * distance, -0.2 * distance, distance);
    const Eigen::Vector3d p1 = T_w_c * Eigen::Vector3d(0.4 * distance, 0.1 * distance, 1.3 * distance);
    for (const double offset : {1e-3, 0.3, 2.0}) {
      const Eigen::Vector3d origin = p0 + offset * Eigen::Vector3d(0.3, -0.5, 0.8);
      const LineBlock line = toBlock(toOrthonormal(movedOrigin(lineThrough(p0, p1), origin)));
      LineFactor factor(observation(0.12, -0.2), observation(0.3, 0.08), kMotion, origin, 300);
      expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &kLineManifold},
                      {s.T_w_bi.data(), s.T_b_c.data(), s.correction.data(), line.data()}, 1e-5);
    }
  }
}

LineBlock lineAlong(const Eigen::Vector3d& d, const Eigen::Vector3d& p = {1, 2, 0.5}) {
  return toBlock(toOrthonormal(lineThrough(p, p + d)));
}

TEST(StructuralFactors, AreTheSineOfTheAngleWhateverTheSign) {
  const double angle = 0.3;
  const LineBlock i = lineAlong({1, 0, 0}), j = lineAlong({std::cos(angle), std::sin(angle), 0});
  const DirectionBlock along(1, 0, 0), against(-std::cos(angle), -std::sin(angle), 0);
  Eigen::Vector3d r;
  const double *pair[] = {i.data(), j.data()}, *parallel[] = {i.data(), along.data()},
               *turned[] = {i.data(), against.data()};
  ASSERT_TRUE(ParallelLinesFactor(50).Evaluate(pair, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 50 * std::sin(angle), 1e-12);
  ASSERT_TRUE(SharedDirectionFactor(50).Evaluate(parallel, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 0, 1e-12);
  ASSERT_TRUE(SharedDirectionFactor(50).Evaluate(turned, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 50 * std::sin(angle), 1e-12);
}

TEST(StructuralFactors, GradientsFromParallelToPerpendicularAndForLinesThroughTheOrigin) {
  const DirectionManifold direction_manifold;
  const Eigen::Vector3d axis = Eigen::Vector3d(0.2, 0.3, -0.9).normalized(), d(1, 0.1, 0.3);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(1, 2, 0.5), Eigen::Vector3d(0, 0, 1e-5), Eigen::Vector3d(0, 90, 0)})
    for (const double angle : {0.0, 1e-6, 0.01, 1.0, 1.57, 3.1}) {
      const Eigen::Vector3d turned = Eigen::AngleAxisd(angle, axis) * d;
      const LineBlock i = lineAlong(d, p), j = lineAlong(turned);
      const DirectionBlock group = turned.normalized();
      expectGradients(SharedDirectionFactor(57), {&kLineManifold, &direction_manifold}, {i.data(), group.data()});
      expectGradients(ParallelLinesFactor(57), {&kLineManifold, &kLineManifold}, {i.data(), j.data()});
    }
}

TEST(VanishingFactor, IsTheAngleBetweenPlaneAndDirection) {
  // The plane of the image line y = 0.5 holds the x axis and (0, 0.5, 1).
  const PoseBlock identity = toBlock(Pose{});
  const CorrectionBlock zero = CorrectionBlock::Zero();
  VanishingFactor factor(observation(-0.3, 0.5), observation(0.3, 0.5), {}, 100);
  const double angle = 0.1;
  const Eigen::Vector3d normal = Eigen::Vector3d(0, 1, -0.5).normalized();
  for (const double sign : {1.0, -1.0}) {
    const DirectionBlock in_plane(1, 0, 0), off = std::cos(angle) * in_plane + sign * std::sin(angle) * normal;
    double r = 0;
    const double* blocks[] = {identity.data(), identity.data(), zero.data(), in_plane.data()};
    ASSERT_TRUE(factor.Evaluate(blocks, &r, nullptr));
    EXPECT_NEAR(r, 0, 1e-12);
    blocks[3] = off.data();
    ASSERT_TRUE(factor.Evaluate(blocks, &r, nullptr));
    EXPECT_NEAR(std::abs(r), 100 * std::sin(angle), 1e-9);
  }
}

TEST(VanishingFactor, GradientsForShortAndLongLines) {
  const Scene s;
  const DirectionManifold direction_manifold;
  const DirectionBlock direction = Eigen::Vector3d(0.5, -0.2, 0.8).normalized();
  for (const double length : {0.02, 0.3, 1.0}) {
    VanishingFactor factor(observation(0.12, -0.2), observation(0.12 + length, -0.2 + 0.5 * length), kMotion, 200);
    expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &direction_manifold},
                    {s.T_w_bi.data(), s.T_b_c.data(), s.correction.data(), direction.data()}, 1e-5);
  }
}

std::shared_ptr<Preintegration> somePreintegration() {
  auto preintegration = std::make_shared<Preintegration>(ImuBias{{0.01, 0.02, -0.01}, {0.05, 0, 0.1}}, ImuNoise{});
  ImuBatch samples;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.005 * i;
    samples.push_back({1400000000000000000 + i * 5000000,
                       {0.5 * std::sin(9 * t), 0.4, -0.3 * std::cos(5 * t)},
                       {std::cos(7 * t), 2 * t, 9.8 + std::sin(20 * t)}});
  }
  preintegration->append(samples);
  return preintegration;
}

TEST(ImuFactor, IsZeroForTheIntegratedMotion) {
  const auto pre = somePreintegration();
  const Pose T_w_bi{expRotation({0.3, 0.1, -1}), {1, 2, 3}};
  const Eigen::Vector3d v_i(0.4, -0.2, 0.1);
  const double dt = pre->dt_s();
  const Pose T_w_bj{T_w_bi.q * pre->deltaR(),
                    T_w_bi.p + v_i * dt + 0.5 * gravityW() * dt * dt + T_w_bi.q * pre->deltaP()};
  MotionBlock motion_i, motion_j;
  motion_i << v_i, pre->bias().gyro, pre->bias().accel;
  motion_j << v_i + gravityW() * dt + T_w_bi.q * pre->deltaV(), pre->bias().gyro, pre->bias().accel;
  const PoseBlock pose_i = toBlock(T_w_bi), pose_j = toBlock(T_w_bj);
  const double* blocks[] = {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data()};
  Eigen::Matrix<double, 15, 1> r;
  ASSERT_TRUE(ImuFactor(pre).Evaluate(blocks, r.data(), nullptr));
  EXPECT_LT(r.norm(), 1e-6);
}

TEST(ImuFactor, Gradients) {
  const auto pre = somePreintegration();
  const PoseBlock pose_i = toBlock(Pose{expRotation({0.3, 0.1, -1}), {1, 2, 3}});
  const PoseBlock pose_j = toBlock(Pose{expRotation({0.32, 0.13, -1.05}), {1.04, 2, 3.02}});
  MotionBlock motion_i, motion_j;
  motion_i << 0.4, -0.2, 0.1, 0.02, 0.01, -0.03, 0.1, 0.05, 0.2;
  motion_j << 0.5, -0.1, 0.1, 0.021, 0.012, -0.03, 0.12, 0.05, 0.21;
  expectGradients(ImuFactor(pre), {&kPoseManifold, nullptr, &kPoseManifold, nullptr},
                  {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data()}, 1e-5);
}

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

}  // namespace
}  // namespace lintel
