// SPDX-License-Identifier: BSD-3-Clause
// Factors of kinds that the solver has no code for, added as doc/architecture.md says under "A factor".
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "DenseReference.h"
#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "lintel/factors/Manifolds.h"
#include "solver/Marginalizer.h"
#include "solver/ReducedSystem.h"
#include "solver/WindowSolver.h"
#include "window/WindowFactors.h"
#include "window/WindowMarginalization.h"

namespace lintel {
namespace {

using namespace test;

/// Height of the body above a plane of constant height: r = weight (z - height). Block: pose.
class HeightFactor final : public ceres::SizedCostFunction<1, kPoseSize> {
 public:
  HeightFactor(double height_m, double weight) : height_m_(height_m), weight_(weight) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = weight_ * (parameters[0][2] - height_m_);
    if (jacobians && jacobians[0]) {
      std::fill_n(jacobians[0], kPoseSize, 0.0);
      jacobians[0][2] = weight_;
    }
    return true;
  }

 private:
  double height_m_, weight_;
};

/// Ties everything there is to each other, with no meaning but with derivatives: the sine of a weighted sum of all
/// components. Blocks: as given.
class MixFactor final : public ceres::CostFunction {
 public:
  explicit MixFactor(const std::vector<int>& sizes) {
    *mutable_parameter_block_sizes() = sizes;
    set_num_residuals(1);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    double sum = 0.1;
    int n = 0;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i)
      for (int k = 0; k < parameter_block_sizes()[i]; ++k) sum += coefficient(n++) * parameters[i][k];
    residuals[0] = 30 * std::sin(sum);
    n = 0;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i)
      for (int k = 0; k < parameter_block_sizes()[i]; ++k, ++n)
        if (jacobians && jacobians[i]) jacobians[i][k] = 30 * std::cos(sum) * coefficient(n);
    return true;
  }

 private:
  static double coefficient(int n) { return 0.2 + 0.05 * (n % 7); }
};

int sizeOf(const BlockKey& key) { return manifoldOf(key.kind)->AmbientSize(); }

std::unique_ptr<ceres::CostFunction> mixOf(const std::vector<BlockKey>& blocks) {
  std::vector<int> sizes;
  sizes.reserve(blocks.size());
  for (const BlockKey& key : blocks) sizes.push_back(sizeOf(key));
  return std::make_unique<MixFactor>(sizes);
}

/// A window off its optimum, all its measurements, and room for more.
class AnyFactorTest : public testing::Test {
 protected:
  AnyFactorTest() {
    TrackSimulationParams few;
    few.duration_s = 2;
    few.max_points_per_frame = 20;
    few.max_lines_per_frame = 8;
    few.point_noise_px = few.line_noise_px = 0.7;
    window_ = trueWindow(fly(ImuSimulatorParams{}, few), 10, 5);
    triangulatePoints(window_, kParams.landmarks, 1);
    triangulateLines(window_, kParams);
    for (std::size_t k = 0; k < window_.frames.size(); ++k)
      window_.frames[k].pose.head<3>() += 0.002 * Eigen::Vector3d(1, -1, static_cast<double>(k));
    window_.directions[3].d_w = DirectionBlock(0.1, 0.2, 1).normalized();
    for (const auto& [id, track] : window_.points)
      if (track.triangulated && track.sightings.size() > 2 && points_.size() < 3) points_.push_back(id);
    for (const auto& [id, track] : window_.lines)
      if (isWellKnown(track) && lines_.size() < 3) lines_.push_back(id);
    factors_ = std::make_unique<WindowFactors>(window_, factor_params_);
    factors_->addMeasurements(kParams);
  }

  static bool isWellKnown(const LineTrack& track) {
    return track.triangulated && !track.degenerate() && track.sightings.size() > 2;
  }

  void addKnowledge() {
    factors_->addGauge();
    factors_->addCalibrationPriors(kParams.calibration, window_.T_b_c());
    factors_->addAxesPrior(kParams.calibration);
    factors_->add(makeBlockPrior(manifoldOf(BlockKey::kMotion), window_.frames.front().motion,
                                 Eigen::VectorXd::Constant(kMotionSize, 0.02)),
                  {{BlockKey::kMotion, window_.frames.front().id}});
  }

  void addMix(const std::vector<BlockKey>& blocks, const ceres::LossFunction* loss = nullptr) {
    factors_->add(mixOf(blocks), {blocks.begin(), blocks.end()}, loss);
  }

  SlidingWindow window_{eurocRig()};
  std::vector<TrackId> points_, lines_;
  const FactorParams factor_params_ = withoutTrackLoss();
  std::unique_ptr<WindowFactors> factors_;
};

/// The equations of ReducedSystem against the dense ones with the same landmarks eliminated.
void expectDense(SlidingWindow& window, const std::vector<Factor>& factors) {
  ReducedSystem system(window, factors, {}, {});
  system.linearise();
  const NormalEquations reduced = system.eliminate();
  std::set<BlockKey> eliminated;
  for (const Factor& factor : factors)
    for (const BlockKey& key : factor.blocks)
      if (std::find(reduced.blocks.begin(), reduced.blocks.end(), key) == reduced.blocks.end()) {
        ASSERT_TRUE(isLandmark(key));
        eliminated.insert(key);
      }
  ASSERT_GT(eliminated.size(), 10u);
  const NormalEquations all = linearise(window, factors, eliminated),
                        dense = withoutFirst(all, all.offsets[eliminated.size()]);
  const Eigen::MatrixXd& H = dense.H;
  const Eigen::VectorXd& b = dense.b;
  ASSERT_EQ(reduced.blocks, dense.blocks);
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseMax(1e-3);
  EXPECT_LT(((reduced.b - b).cwiseQuotient(scale)).norm(), 1e-7 * b.cwiseQuotient(scale).norm());
  const Eigen::MatrixXd difference =
      scale.cwiseInverse().asDiagonal() * (reduced.H - H) * scale.cwiseInverse().asDiagonal();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-7);
}

TEST_F(AnyFactorTest, AnyMixOfBlocksIsLinearised) {
  ASSERT_EQ(points_.size(), 3u);
  ASSERT_EQ(lines_.size(), 3u);
  addKnowledge();
  const BlockKey pose{BlockKey::kPose, 2}, motion{BlockKey::kMotion, 3}, extrinsics{BlockKey::kExtrinsics, 0},
      correction{BlockKey::kCorrection, 0}, direction{BlockKey::kDirection, 3};
  const ceres::CauchyLoss loss(0.5);
  const std::vector<std::vector<BlockKey>> mixes{
      {pose},
      {motion, pose},
      {pose, {BlockKey::kPoint, points_[0]}},
      {{BlockKey::kLine, lines_[0]}, {BlockKey::kLine, lines_[1]}},
      {{BlockKey::kPoint, points_[1]}, {BlockKey::kLine, lines_[2]}, direction},
      {pose, motion, extrinsics, correction, direction, {BlockKey::kPoint, points_[2]}},
      {pose, extrinsics, correction, {BlockKey::kPoint, points_[0]}},  // the blocks of an image's residual, but none
      {{BlockKey::kLine, lines_[0]}, direction}};                      // as a line tied to a direction, but none
  for (const auto& mix : mixes) {
    addMix(mix);
    addMix(mix, &loss);
    expectDense(window_, factors_->factors());
  }
}

TEST_F(AnyFactorTest, IsSolved) {
  addKnowledge();
  factors_->add(std::make_unique<HeightFactor>(window_.frames[4].pose[2] + 0.05, 1e3), {{BlockKey::kPose, 4}});
  addMix({{BlockKey::kPoint, points_[0]}, {BlockKey::kLine, lines_[0]}});
  const double wanted = window_.frames[4].pose[2] + 0.05;
  const SolveSummary summary = solveWindow(window_, factors_->factors(), kParams.calibration, {50});
  SlidingWindow reference = window_;  // robust losses have minima beside each other: is this one?
  const double least = solveWithCeres(reference, factors_->factors());
  EXPECT_LT(summary.final_cost, 1.01 * least);
  EXPECT_NEAR(window_.frames[4].pose[2], reference.frames[4].pose[2], 1e-3);
  EXPECT_LT(std::abs(window_.frames[4].pose[2] - wanted), 0.04) << "it pulls";
}

/// Information about height in a prior.
double heightInformation(SlidingWindow& window, const WindowPrior& prior, FrameId frame) {
  const NormalEquations eq = linearise(window, {factorOf(prior)}, {{BlockKey::kPose, frame}});
  return eq.H(2, 2);
}

TEST_F(AnyFactorTest, IsCarriedIntoThePrior) {
  // from the oldest frame's height to the next one's: by the factor itself, and by what ties the two
  SlidingWindow without = window_;
  marginaliseOldest(without, factors_->factors(), {});
  factors_->add(std::make_unique<HeightFactor>(window_.frames[0].pose[2], 1e4), {{BlockKey::kPose, 0}});
  factors_->add(std::make_unique<HeightFactor>(window_.frames[2].pose[2], 1e4), {{BlockKey::kPose, 2}});
  SlidingWindow with = window_;
  marginaliseOldest(with, factors_->factors(), {});
  ASSERT_EQ(without.priors.size(), 1u);
  ASSERT_EQ(with.priors.size(), 1u);
  EXPECT_GT(heightInformation(with, with.priors[0], 1), 2 * heightInformation(without, without.priors[0], 1));
  EXPECT_LT(heightInformation(with, with.priors[0], 2), 1e7) << "a residual of a frame that stays is not carried";
}

TEST_F(AnyFactorTest, APriorHoldsNeitherLandmarksNorDirections) {
  TrackId leaving = 0, staying = 0;
  for (const auto& [id, track] : window_.points) {
    if (!track.triangulated || track.sightings.size() < 2) continue;
    (track.sightings.front().frame == 0 ? leaving : staying) = id;
  }
  ASSERT_NE(leaving, staying);
  addMix({{BlockKey::kPoint, leaving}, {BlockKey::kPose, 3}});
  addMix({{BlockKey::kPoint, leaving}, {BlockKey::kPoint, staying}});
  addMix({{BlockKey::kPose, 0}, {BlockKey::kDirection, 3}});
  marginaliseOldest(window_, factors_->factors(), {});
  ASSERT_EQ(window_.priors.size(), 1u);
  for (const BlockKey& key : window_.priors[0].blocks) {
    EXPECT_FALSE(isLandmark(key));
    EXPECT_NE(key.kind, BlockKey::kDirection);
  }
}

}  // namespace
}  // namespace lintel
