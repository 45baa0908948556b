// SPDX-License-Identifier: BSD-3-Clause
#include "solver/Marginalizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <random>

#include "DenseReference.h"
#include "TestWindow.h"
#include "landmarks/PointTriangulation.h"
#include "lintel/factors/PriorFactors.h"
#include "lintel/geometry/Rotation.h"
#include "window/LastingPoints.h"
#include "window/WindowFactors.h"
#include "window/WindowMarginalization.h"

namespace lintel {
namespace {

using namespace test;

std::set<BlockKey> firstFrameAndPoints(const SlidingWindow& window) {
  std::set<BlockKey> dropped{{BlockKey::kPose, 0}, {BlockKey::kMotion, 0}};
  for (const auto& [id, track] : window.points)
    if (track.triangulated) dropped.insert({BlockKey::kPoint, id});
  return dropped;
}

/// The prior's residual at block values that differ from the window's by `dx` in the tangent space.
Eigen::VectorXd residualAt(SlidingWindow& window, const WindowPrior& prior, const Eigen::VectorXd& dx) {
  std::vector<Eigen::VectorXd> moved;
  std::vector<const double*> pointers;
  Eigen::Index at = 0;
  for (const BlockKey& key : prior.blocks) {
    const auto manifold = manifoldOf(key.kind);
    Eigen::VectorXd x(manifold->AmbientSize());
    manifold->Plus(window.block(key), dx.data() + at, x.data());
    moved.push_back(x);
    at += manifold->TangentSize();
  }
  pointers.reserve(moved.size());
  for (const Eigen::VectorXd& x : moved) pointers.push_back(x.data());
  Eigen::VectorXd r(prior.factor->num_residuals());
  prior.factor->Evaluate(pointers.data(), r.data(), nullptr);
  return r;
}

/// A small window off its optimum, with every kind of residual that is marginalised.
class MarginalizerTest : public testing::Test {
 protected:
  MarginalizerTest() {
    TrackSimulationParams few;
    few.duration_s = 2;
    few.max_points_per_frame = 25;
    few.point_noise_px = 0.7;
    few.max_lines_per_frame = 5;
    flight_ = fly(ImuSimulatorParams{}, few);
    window_ = trueWindow(flight_, 10, 5);
    triangulatePoints(window_, kParams.landmarks, 1);
    for (std::size_t k = 0; k < window_.frames.size(); ++k)
      window_.frames[k].pose.head<3>() += 0.002 * Eigen::Vector3d(1, -1, static_cast<double>(k));
    factors_ = std::make_unique<WindowFactors>(window_, kParams.factors);
    factors_->addImu();
    factors_->addPoints();
    factors_->addCalibrationPriors(kParams.calibration, flight_.rig.T_b_c);
    factors_->addGauge();
    Eigen::VectorXd sigma = Eigen::VectorXd::Constant(kMotionSize, 0.1);
    factors_->add(makeBlockPrior(manifoldOf(BlockKey::kMotion), window_.frames[0].motion, sigma),
                  {{BlockKey::kMotion, 0}});
  }

  TrackedFlight flight_;
  SlidingWindow window_{eurocRig()};
  std::unique_ptr<WindowFactors> factors_;
};

TEST_F(MarginalizerTest, CostOverDisplacementsIsThatOfExplicitElimination) {
  const std::set<BlockKey> dropped = firstFrameAndPoints(window_);
  ASSERT_GT(dropped.size(), 12u);
  const NormalEquations eq = linearise(window_, factors_->factors(), dropped);
  const Eigen::Index m = eq.offsets[dropped.size()], n = eq.H.rows() - m;
  const auto prior = marginalise(window_, factors_->factors(), dropped);
  ASSERT_TRUE(prior);
  ASSERT_EQ(std::vector<BlockKey>(eq.blocks.begin() + static_cast<std::ptrdiff_t>(dropped.size()), eq.blocks.end()),
            prior->blocks);
  const double cost_0 = 0.5 * residualAt(window_, *prior, Eigen::VectorXd::Zero(n)).squaredNorm();
  // the dropped blocks' best reaction to a displacement of the others, in one dense solve
  const Eigen::MatrixXd Hmm = eq.H.topLeftCorner(m, m);
  const auto bestCost = [&](const Eigen::VectorXd& dx) {
    Eigen::VectorXd all(m + n);
    all << -solved(Hmm, eq.b.head(m) + eq.H.topRightCorner(m, n) * dx), dx;
    return 0.5 * all.dot(eq.H * all) + eq.b.dot(all);
  };
  const double best_0 = bestCost(Eigen::VectorXd::Zero(n));
  std::mt19937 random(5);
  std::normal_distribution<double> gauss(0, 1e-2);
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd dx(n);
    for (double& v : dx) v = gauss(random);
    const double expected = bestCost(dx) - best_0;
    const double cost = 0.5 * residualAt(window_, *prior, dx).squaredNorm() - cost_0;
    EXPECT_NEAR(cost, expected, 1e-6 * std::abs(expected));
  }
}

TEST_F(MarginalizerTest, GradientIsThatOfExplicitElimination) {
  const std::set<BlockKey> dropped = firstFrameAndPoints(window_);
  const NormalEquations eq = linearise(window_, factors_->factors(), dropped);
  const Eigen::VectorXd expected = withoutFirst(eq, eq.offsets[dropped.size()]).b;
  const auto prior = marginalise(window_, factors_->factors(), dropped);
  ASSERT_TRUE(prior);
  const NormalEquations again = linearise(window_, {factorOf(*prior)}, {});
  ASSERT_EQ(again.blocks, prior->blocks);
  EXPECT_LT((again.b - expected).norm(), 1e-6 * expected.norm());
}

TEST_F(MarginalizerTest, PointsThatStayMayGoLater) {
  const std::set<BlockKey> dropped = firstFrameAndPoints(window_);
  std::set<BlockKey> points;
  for (const BlockKey& key : dropped)
    if (key.kind == BlockKey::kPoint && points.size() < 3) points.insert(key);
  const FactorParams params = withoutTrackLoss();  // as it is with points that stay
  WindowFactors factors(window_, params);
  factors.addImu();
  factors.addPoints();
  factors.addCalibrationPriors(kParams.calibration, flight_.rig.T_b_c);
  const auto at_once = marginalise(window_, factors.factors(), dropped);
  std::set<BlockKey> without_points;
  std::set_difference(dropped.begin(), dropped.end(), points.begin(), points.end(),
                      std::inserter(without_points, without_points.end()));
  const auto with_points = marginalise(window_, factors.factors(), without_points, {points});
  ASSERT_TRUE(at_once && with_points);
  ASSERT_EQ(with_points->blocks.size(), at_once->blocks.size() + 3);
  const auto later = marginalise(window_, {factorOf(*with_points)}, points);
  ASSERT_TRUE(later);
  ASSERT_EQ(later->blocks, at_once->blocks);
  const Eigen::MatrixXd &expected = at_once->factor->information(), &H = later->factor->information();
  EXPECT_LT((H - expected).norm(), 1e-6 * expected.norm());
  const Eigen::VectorXd b = later->factor->root().transpose() * later->factor->constant();
  const Eigen::VectorXd b_expected = at_once->factor->root().transpose() * at_once->factor->constant();
  EXPECT_LT((b - b_expected).norm(), 1e-6 * b_expected.norm());
}

TEST_F(MarginalizerTest, WhatWalksGainsItsWalkAsCovariance) {
  const BlockKey point{BlockKey::kPoint, window_.points.begin()->first}, motion{BlockKey::kMotion, 0},
      mean{BlockKey::kMeanBias, 0};
  PriorBlock of_point{manifoldOf(BlockKey::kPoint), window_.points.begin()->second.point, GaugeAction::kPoint};
  of_point.origin_w = window_.points.begin()->second.origin_w;
  constexpr int n = kMotionSize + kMeanBiasSize + kPointTangent;
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) A(i, k) += 0.3 * std::sin(1 + 3.7 * i + 1.3 * k * k);
  const PriorFactor before({{manifoldOf(BlockKey::kMotion), window_.frames[0].motion},
                            {manifoldOf(BlockKey::kMeanBias), window_.mean_bias},
                            of_point},
                           A, Eigen::VectorXd::LinSpaced(n, -1, 1));
  const auto after = marginalise(window_, {{&before, nullptr, {motion, mean, point}}}, {}, {{point}, 0.2, 0.5});
  ASSERT_TRUE(after);
  ASSERT_EQ(after->blocks, (std::vector<BlockKey>{motion, mean, point}));
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd covariance = solved(before.information(), unit);
  covariance.diagonal().segment<3>(kMotionSize).array() += 0.5 * 0.5;
  covariance.diagonal().tail<3>().array() += 0.2 * 0.2;
  EXPECT_LT((solved(after->factor->information(), unit) - covariance).norm(), 1e-9 * covariance.norm());
  // the best estimate stays where it was
  const auto best = [](const PriorFactor& prior) -> Eigen::VectorXd {
    return solved(prior.information(), prior.root().transpose() * prior.constant());
  };
  EXPECT_LT((best(*after->factor) - best(before)).norm(), 1e-9 * best(before).norm());
}

TEST_F(MarginalizerTest, AScaleThatWalksAddsTheVarianceOfWhatAScaledWindowDiffersBy) {
  const BlockKey pose{BlockKey::kPose, 3}, motion{BlockKey::kMotion, 2}, correction{BlockKey::kCorrection, 0},
      point{BlockKey::kPoint, window_.points.begin()->first};
  const std::vector<BlockKey> keys{motion, pose, correction, point};
  // the window scaled about its second frame
  constexpr double kScale = 1 + 1e-6;
  const Eigen::Vector3d centre_w = window_.frames[1].T_w_b().p;
  SlidingWindow scaled = window_;
  for (WindowFrame& frame : scaled.frames) {
    frame.pose.head<3>() = centre_w + kScale * (frame.T_w_b().p - centre_w);
    frame.motion.segment<3>(kVelocityAt) *= kScale;
  }
  PointTrack& far = scaled.points.begin()->second;
  far.point.head<3>() =
      far.point[3] *
      (centre_w + kScale * (window_.positionOf(window_.points.begin()->second) - centre_w) - far.origin_w);
  far.point.normalize();
  Eigen::VectorXd direction;
  std::vector<PriorBlock> blocks;
  for (const BlockKey& key : keys) {
    const auto manifold = manifoldOf(key.kind);
    Eigen::VectorXd change(manifold->TangentSize());
    manifold->Minus(scaled.block(key), window_.block(key), change.data());
    const Eigen::Index at = direction.size();
    direction.conservativeResize(at + change.size());
    direction.tail(change.size()) = change / (kScale - 1);
    blocks.push_back({manifold, Eigen::Map<const Eigen::VectorXd>(window_.block(key), manifold->AmbientSize())});
  }
  blocks.back().action = GaugeAction::kPoint;
  blocks.back().origin_w = window_.points.begin()->second.origin_w;
  const Eigen::Index n = direction.size();
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) A(i, k) += 0.2 * std::sin(1 + 3.7 * i + 1.3 * k * k);
  const PriorFactor before(blocks, A, Eigen::VectorXd::LinSpaced(n, -1, 1));
  Staying staying{{point}};
  staying.scale_walk = 0.3;
  const auto after = marginalise(window_, {{&before, nullptr, {keys.begin(), keys.end()}}}, {}, staying);
  ASSERT_TRUE(after);
  ASSERT_EQ(after->blocks, keys);
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd covariance = solved(before.information(), unit) + 0.3 * 0.3 * direction * direction.transpose();
  EXPECT_LT((solved(after->factor->information(), unit) - covariance).norm(), 1e-5 * covariance.norm());
  const auto best = [](const PriorFactor& prior) -> Eigen::VectorXd {
    return solved(prior.information(), prior.root().transpose() * prior.constant());
  };
  EXPECT_LT((best(*after->factor) - best(before)).norm(), 1e-5 * best(before).norm());
}

TEST_F(MarginalizerTest, NothingStaysNothingComes) {
  WindowFactors factors(window_, kParams.factors);
  factors.addGauge();
  EXPECT_FALSE(marginalise(window_, factors.factors(), {{BlockKey::kPose, 0}}));
}

/// How much a prior resists moving (turning about z) the whole world, relative to its strongest direction.
double resistance(SlidingWindow& window, const WindowPrior& prior, const Eigen::Vector3d& shift, double yaw_rate) {
  const NormalEquations eq = linearise(window, {factorOf(prior)}, {});
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(eq.H.rows());
  const Eigen::Vector3d turn = yaw_rate * Eigen::Vector3d::UnitZ();
  for (std::size_t i = 0; i < eq.blocks.size(); ++i) {
    const BlockKey& key = eq.blocks[i];
    if (key.kind == BlockKey::kPose) {
      const Pose T_w_b = window.frame(key.id).T_w_b();
      direction.segment<3>(eq.offsets[i]) = shift + turn.cross(T_w_b.p);
      direction.segment<3>(eq.offsets[i] + 3) = T_w_b.q.conjugate() * turn;
    } else if (key.kind == BlockKey::kMotion) {
      direction.segment<3>(eq.offsets[i]) = turn.cross(velocityOf(window.frame(key.id).motion.data()));
    } else if (key.kind == BlockKey::kPoint) {
      const PointTrack& track = window.points.at(key.id);
      Eigen::Vector4d moved = Eigen::Vector4d::Zero();
      moved.head<3>() = track.point[3] * (shift + turn.cross(window.positionOf(track)));
      RowMajorMatrix minus(kPointTangent, kPointSize);
      manifoldOf(key.kind)->MinusJacobian(track.point.data(), minus.data());
      direction.segment<3>(eq.offsets[i]) = minus * moved;
    }
  }
  direction.normalize();
  const double strongest = std::sqrt(eq.H.diagonal().maxCoeff());
  return std::sqrt(std::abs(direction.dot(eq.H * direction))) / strongest;
}

/// Ten frames at their true places with points.
SlidingWindow exactWindow() {
  TrackSimulationParams tracks;
  tracks.duration_s = 3;
  tracks.max_points_per_frame = 60;
  const TrackedFlight flight = fly(perfectImu(), tracks);
  SlidingWindow window = trueWindow(flight, 0, 10);
  triangulatePoints(window, kParams.landmarks, 1);
  return window;
}

TEST(MarginalisedPrior, LeavesPositionAndYawFree) {
  SlidingWindow window = exactWindow();
  for (int round = 0; round < 3; ++round) {  // a prior goes into the next one
    marginaliseOldest(window, kParams);
    window.removeFrame(window.frames.front().id, true);
    ASSERT_EQ(window.priors.size(), 1u);
    const WindowPrior& prior = window.priors[0];
    EXPECT_GE(pointsInPriors(window).size(), 10u);
    EXPECT_LT(resistance(window, prior, Eigen::Vector3d::UnitX(), 0), 1e-6) << round;
    EXPECT_LT(resistance(window, prior, Eigen::Vector3d::UnitY(), 0), 1e-6) << round;
    EXPECT_LT(resistance(window, prior, Eigen::Vector3d::UnitZ(), 0), 1e-6) << round;
    EXPECT_LT(resistance(window, prior, Eigen::Vector3d::Zero(), 1), 1e-6) << round;
    // the measure is not blind: one frame alone may not move
    const NormalEquations eq = linearise(window, {factorOf(prior)}, {});
    const auto pose = std::find_if(eq.blocks.begin(), eq.blocks.end(),
                                   [](const BlockKey& key) { return key.kind == BlockKey::kPose; });
    ASSERT_NE(pose, eq.blocks.end());
    const Eigen::Index at = eq.offsets[static_cast<std::size_t>(pose - eq.blocks.begin())];
    EXPECT_GT(std::sqrt(eq.H(at, at) / eq.H.diagonal().maxCoeff()), 1e-4);
  }
}

TEST(MarginalisedPrior, LeavesPositionAndYawFreeWhereverTheWindowHasMoved) {
  SlidingWindow window = exactWindow();
  for (int round = 0; round < 3; ++round) {
    marginaliseOldest(window, kParams);
    window.removeFrame(window.frames.front().id, true);
    // the solver moves the window by centimetres and degrees, all of it and its frames among each other
    const Eigen::Quaterniond yaw(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));
    for (WindowFrame& frame : window.frames) {
      const Pose T_w_b = Pose{yaw, {0.2, -0.1, 0.05}} * frame.T_w_b();
      const auto little = 0.003 * static_cast<double>(frame.id % 3);
      frame.pose = toBlock(T_w_b * Pose{expRotation({little, -little, little}), {little, 0, -little}});
      frame.motion.segment<3>(kVelocityAt) = yaw * velocityOf(frame.motion.data()) + Eigen::Vector3d(little, 0, 0);
    }
    for (auto& [id, track] : window.points) {
      const Eigen::Vector3d p_w = yaw * window.positionOf(track) + Eigen::Vector3d(0.2, -0.1, 0.05);
      track.point.head<3>() = track.point[3] * (p_w - track.origin_w);
      track.point.normalize();
    }
    const WindowPrior& prior = window.priors[0];
    EXPECT_LT(resistance(window, prior, Eigen::Vector3d::UnitX(), 0), 1e-6) << round;
    EXPECT_LT(resistance(window, prior, Eigen::Vector3d::UnitZ(), 0), 1e-6) << round;
    EXPECT_LT(resistance(window, prior, Eigen::Vector3d::Zero(), 1), 1e-6) << round;
    // and without the alignment it would not be
    WindowPrior plain{prior.blocks, nullptr};
    std::vector<PriorBlock> blocks = prior.factor->blocks();
    for (PriorBlock& block : blocks)
      if (block.action != GaugeAction::kPoint) block.action = GaugeAction::kNone;
    plain.factor = std::make_shared<PriorFactor>(blocks, prior.factor->root(), prior.factor->constant());
    EXPECT_GT(resistance(window, plain, Eigen::Vector3d::Zero(), 1), 1e-5) << round;
  }
}

}  // namespace
}  // namespace lintel
