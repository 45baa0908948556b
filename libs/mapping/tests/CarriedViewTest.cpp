// SPDX-License-Identifier: BSD-3-Clause
#include "../src/CarriedView.h"

#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include "lintel/factors/Manifolds.h"
#include "lintel/factors/PointFactor.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

class CarriedViewTest : public testing::Test {
 protected:
  Pose T_w_a_{expRotation({0.1, -0.2, 0.3}), {0.2, 0.1, 0}}, T_w_n_{expRotation({0.2, -0.1, 0.4}), {0.5, 0.2, 0.1}},
      T_w_b_{expRotation({0.12, -0.16, 0.33}), {0.31, 0.12, 0.05}};
  Carriage carriage_{T_w_b_, T_w_a_, T_w_n_, 0.3};
  Camera camera_{752, 480, 458, 457, 367, 248, {-0.28, 0.07, 2e-4, 2e-5}};
  PointFactor view_{{400, 200}, camera_, {{0.3, 0.1, -0.2}, {0.1, 0.2, 0.3}}, {0.1, 0.2, 0.3}, 0.5};
  PoseBlock a_ = toBlock(T_w_a_), b_ = toBlock(T_w_n_), k_ = toBlock(T_w_b_),
            extrinsics_ = toBlock(Pose{expRotation({0.01, 0.02, 0.03}), {0.05, -0.02, 0.01}});
  double scale_ = 1;
  CorrectionBlock correction_ = CorrectionBlock::Constant(1e-3);
  PointBlock point_ = PointBlock(0.4, 0.2, 3, 1).normalized();
};

TEST_F(CarriedViewTest, TheCarriedPoseIsWhereItWas) {
  const Pose T = carriage_.pose(T_w_a_, T_w_n_.p, 1);
  EXPECT_LT((T.p - T_w_b_.p).norm(), 1e-14);
  EXPECT_LT(logRotation(T.q.conjugate() * T_w_b_.q).norm(), 1e-14);
}

TEST_F(CarriedViewTest, ItMovesWithTheWorldAndFollowsTheScaleOfTheWay) {
  const Pose T_v_w{expRotation({0, 0, 1}), {3, 4, 5}};
  const Pose T = carriage_.pose(T_v_w * T_w_a_, T_v_w * T_w_n_.p, 1);
  EXPECT_LT((T.p - T_v_w * T_w_b_.p).norm(), 1e-13);
  const Pose twice = carriage_.pose({T_w_a_.q, 2 * T_w_a_.p}, 2 * T_w_n_.p, 2);
  EXPECT_LT((twice.p - 2 * T_w_b_.p).norm(), 1e-13);
}

TEST_F(CarriedViewTest, ItsResidualIsThatOfTheView) {
  const CarriedView<PointTarget> carried(view_, carriage_);
  const double* of_view[] = {k_.data(), extrinsics_.data(), correction_.data(), point_.data()};
  const double* of_carried[] = {a_.data(), extrinsics_.data(), correction_.data(), point_.data(), b_.data(), &scale_};
  Eigen::Vector2d expected, r;
  view_.Evaluate(of_view, expected.data(), nullptr);
  carried.Evaluate(of_carried, r.data(), nullptr);
  EXPECT_GT(expected.norm(), 1);
  EXPECT_LT((r - expected).norm(), 1e-9 * expected.norm());
}

TEST_F(CarriedViewTest, JacobiansAgreeWithNumericOnes) {
  const CarriedView<PointTarget> carried(view_, carriage_);
  PoseManifold pose;
  const std::vector<const ceres::Manifold*> manifolds{&pose, &pose, nullptr, nullptr, &pose, nullptr};
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-3;
  ceres::GradientChecker checker(&carried, &manifolds, options);
  scale_ = 1.1;
  const double* blocks[] = {a_.data(), extrinsics_.data(), correction_.data(), point_.data(), b_.data(), &scale_};
  ceres::GradientChecker::ProbeResults results;
  EXPECT_TRUE(checker.Probe(blocks, 1e-6, &results)) << results.error_log;
}

}  // namespace
}  // namespace lintel
