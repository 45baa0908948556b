// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ReducedSystem.h"

#include <gtest/gtest.h>

#include "DenseReference.h"
#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/factors/StructuralFactor.h"

namespace lintel {
namespace {

using namespace test;

/// A window off its optimum with points, lines, and lines tied to a shared direction.
class ReducedSystemTest : public testing::Test {
 protected:
  ReducedSystemTest() {
    TrackSimulationParams few;
    few.duration_s = 2;
    few.max_points_per_frame = 20;
    few.point_noise_px = few.line_noise_px = 0.7;
    few.max_lines_per_frame = 8;
    window_ = trueWindow(fly(ImuSimulatorParams{}, few), 10, 5);
    triangulatePoints(window_, kParams.landmarks, 1);
    triangulateLines(window_, kParams);
    for (std::size_t k = 0; k < window_.frames.size(); ++k)
      window_.frames[k].pose.head<3>() += 0.002 * Eigen::Vector3d(1, -1, static_cast<double>(k));
    window_.correction << 0.3, -0.2, 0.1, 0.4, 1e-3, -1e-3, 0, 1e-3;
    window_.directions[3].d_w = DirectionBlock(0.1, 0.2, 1).normalized();
    factors_ = std::make_unique<WindowFactors>(window_, kParams.factors);
    factors_->addAxesPrior(kParams.calibration);
    factors_->addImu();
    factors_->addPoints();
    factors_->addLines(kParams.degeneracy);
    factors_->addCalibrationPriors(kParams.calibration, window_.T_b_c());
    factors_->add(makeMeanBiasPrior({0.1, 0, 0}, kParams.initializer), {{BlockKey::kMeanBias, 0}});
    factors_->addGauge();
    for (const auto& [id, track] : window_.lines)
      if (track.triangulated && !track.degenerate() && lines_++ % 2 == 0)
        factors_->add(std::make_unique<SharedDirectionFactor>(10.0),
                      {{BlockKey::kLine, id}, {BlockKey::kDirection, 3}});
    for (auto& [id, track] : window_.lines) {  // and some that have a direction only
      if (track.triangulated && !track.degenerate()) continue;
      track.group = 3;
      for (const LineSighting& s : track.sightings) factors_->addVanishing(track, s, window_, kParams.degeneracy);
      vanishing_ += !track.sightings.empty();
    }
  }

  std::set<BlockKey> landmarks() const {
    std::set<BlockKey> result;
    for (const Factor& factor : factors_->factors())
      for (const BlockKey& key : factor.blocks)
        if (isLandmark(key)) result.insert(key);
    return result;
  }

  SlidingWindow window_{eurocRig()};
  std::unique_ptr<WindowFactors> factors_;
  int lines_ = 0, vanishing_ = 0;
};

TEST_F(ReducedSystemTest, EqualsTheSchurComplementOfTheDenseSystem) {
  const std::set<BlockKey> eliminated = landmarks();
  ASSERT_GT(eliminated.size(), 15u);
  ASSERT_GE(lines_, 2);
  ASSERT_GE(vanishing_, 1);
  const NormalEquations all = linearise(window_, factors_->factors(), eliminated),
                        dense = withoutFirst(all, all.offsets[eliminated.size()]);
  const Eigen::MatrixXd& H = dense.H;
  const Eigen::VectorXd& b = dense.b;
  const Eigen::Index n = H.rows();

  ReducedSystem system(window_, factors_->factors(), {}, {});
  system.linearise();
  const NormalEquations reduced = system.eliminate();
  ASSERT_EQ(reduced.blocks, dense.blocks);
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i) {
    EXPECT_NEAR(reduced.b[i], b[i], 1e-7 * scale[i] * b.cwiseQuotient(scale).norm()) << i;
    for (Eigen::Index j = 0; j < n; ++j)
      EXPECT_NEAR(reduced.H(i, j), H(i, j), 1e-7 * scale[i] * scale[j]) << i << " " << j;
  }
}

/// By what share the later window's positions are farther from its oldest one.
double scaleChange(const SlidingWindow& before, const SlidingWindow& after) {
  double along = 0, square = 0;
  for (std::size_t k = 1; k < before.frames.size(); ++k) {
    const auto fromOldest = [k](const SlidingWindow& w) {
      return Eigen::Vector3d(w.frames[k].T_w_b().p - w.frames[0].T_w_b().p);
    };
    along += fromOldest(before).dot(fromOldest(after) - fromOldest(before));
    square += fromOldest(before).squaredNorm();
  }
  return along / square;
}

TEST_F(ReducedSystemTest, AStepSolvesTheDampedDenseSystem) {
  // no damping to speak of: the whole system's solution, landmarks included
  const NormalEquations dense = linearise(window_, factors_->factors(), landmarks());
  const Eigen::VectorXd expected = -solved(dense.H, dense.b);
  const double decrease = -0.5 * expected.dot(dense.b);
  const SlidingWindow before = window_;
  ReducedSystem system(window_, factors_->factors(), {}, {});
  const double cost = system.linearise();
  EXPECT_NEAR(system.cost(), cost, 1e-9 * cost);
  ASSERT_TRUE(system.solve(1e-12));
  EXPECT_NEAR(system.modelDecrease(), decrease, 1e-4 * decrease);
  const NormalEquations states = system.eliminate();
  const Eigen::VectorXd step_of_states = -solved(states.H, states.b);
  EXPECT_NEAR(system.statesMove(), std::sqrt(step_of_states.dot(states.H * step_of_states)),
              1e-4 * system.statesMove());
  system.apply();
  const ScaleStep scale(before.frames[0].T_w_b().p, scaleChange(before, window_));
  for (std::size_t i = 0; i < dense.blocks.size(); ++i) {
    const BlockKey& key = dense.blocks[i];
    const auto manifold = manifoldOf(key.kind);
    SlidingWindow start = before, moved = before;
    Eigen::VectorXd step(manifold->TangentSize()), want = expected.segment(dense.offsets[i], manifold->TangentSize());
    if (isLandmark(key)) {  // of second order in the change of scale
      scale.plus(key.kind, originOf(before, key), start.block(key), want.data(), moved.block(key));
      manifold->Minus(moved.block(key), start.block(key), want.data());
    }
    manifold->Minus(window_.block(key), start.block(key), step.data());
    EXPECT_LT((step - want).norm(), 2e-3 * want.norm() + 1e-6) << "block " << i;
  }
  system.revert();
  for (const BlockKey& key : dense.blocks) {
    SlidingWindow start = before;
    const auto size = static_cast<std::size_t>(manifoldOf(key.kind)->AmbientSize());
    EXPECT_TRUE(std::equal(start.block(key), start.block(key) + size, window_.block(key)));
  }
}

TEST_F(ReducedSystemTest, TheGradientIsThatOfTheCost) {
  // the loss of whole tracks included, which Ceres cannot have
  const NormalEquations dense = linearise(window_, factors_->factors(), {});
  ReducedSystem system(window_, factors_->factors(), {}, {});
  system.linearise();
  for (std::size_t i = 0; i < dense.blocks.size(); ++i) {
    const auto manifold = manifoldOf(dense.blocks[i].kind);
    std::vector<double> saved(static_cast<std::size_t>(manifold->AmbientSize()));
    double* block = window_.block(dense.blocks[i]);
    std::copy_n(block, saved.size(), saved.begin());
    for (int d = 0; d < manifold->TangentSize(); ++d) {
      const double scale = std::sqrt(dense.H(dense.offsets[i] + d, dense.offsets[i] + d));
      const double h = 1e-4 / scale;
      double cost[2];
      for (int side = 0; side < 2; ++side) {
        Eigen::VectorXd step = Eigen::VectorXd::Zero(manifold->TangentSize());
        step[d] = side ? h : -h;
        manifold->Plus(saved.data(), step.data(), block);
        cost[side] = system.cost();
      }
      std::copy(saved.begin(), saved.end(), block);
      EXPECT_NEAR((cost[1] - cost[0]) / (2 * h * scale), dense.b[dense.offsets[i] + d] / scale, 2e-3)
          << "block " << i << " direction " << d;
    }
  }
}

TEST_F(ReducedSystemTest, FrozenBlocksAreConstants) {
  const std::set<BlockKey> frozen{{BlockKey::kExtrinsics, 0}, {BlockKey::kCorrection, 0}};
  const SlidingWindow before = window_;
  ReducedSystem system(window_, factors_->factors(), {}, frozen);
  const double cost = system.linearise();
  ASSERT_TRUE(system.solve(1e-4));
  system.apply();
  EXPECT_LT(system.cost(), cost);
  EXPECT_EQ(window_.extrinsics, before.extrinsics);
  EXPECT_EQ(window_.correction, before.correction);
}

}  // namespace
}  // namespace lintel
