// SPDX-License-Identifier: BSD-3-Clause
// The structural constraint over all pairs of lines [Lim2021] against the same by a direction that they share.
//
// Let a_i be the angles (two each) of n lines to any direction near them, small. With a shared direction D, free, and a
// standard deviation of sigma for each line, the constraint is the sum of |a_i - D|^2 / sigma^2. The best D is the mean
// of the a_i, and with it
//
//   sum_i |a_i - mean|^2 / sigma^2 = sum_{i<j} |a_i - a_j|^2 / (n sigma^2)
//
// so that all pairs, with a standard deviation of sigma sqrt(n) each, make the same quadratic form in the lines: the
// same optimum and, with D marginalised, the same covariance. What is left are second-order terms in the angles: both
// factors measure sines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "DenseReference.h"
#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/geometry/Rotation.h"
#include "solver/ReducedSystem.h"
#include "solver/WindowSolver.h"
#include "window/WindowFactors.h"

namespace lintel {
namespace {

using namespace test;

constexpr double kSigma_rad = 2e-3;
constexpr std::uint64_t kDirection = 3;

Eigen::Vector3d directionOf(const LineTrack& track) {
  return lineFromBlock(track.line.data()).plucker().d.normalized();
}

SlidingWindow noisyWindow() {
  TrackSimulationParams tracks;
  tracks.duration_s = 2;
  tracks.max_points_per_frame = 30;
  tracks.max_lines_per_frame = 60;
  tracks.axis_parallel_share = 1;
  tracks.point_noise_px = tracks.line_noise_px = 0.3;
  SlidingWindow window = trueWindow(fly(ImuSimulatorParams{}, tracks), 10, 6);
  triangulatePoints(window, kParams.landmarks, 1);
  triangulateLines(window, kParams);
  return window;
}

/// Good lines along the axis of the world that has most of them, as far as their triangulation tells; the window gets
/// that axis as a direction.
std::vector<TrackId> parallelLines(SlidingWindow& window) {
  std::vector<TrackId> most;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<TrackId> lines;
    for (const auto& [id, track] : window.lines)
      if (track.triangulated && !track.degenerate() && track.sightings.size() > 3 &&
          std::abs(directionOf(track)[axis]) > std::cos(0.1))
        lines.push_back(id);
    if (lines.size() <= most.size()) continue;
    most = lines;
    window.directions[kDirection].d_w = Eigen::Vector3d::Unit(axis);
  }
  return most;
}

enum class Structure { kNone, kShared, kPairs };

WindowFactors factorsOf(const SlidingWindow& window, const std::vector<TrackId>& lines, Structure structure) {
  FactorParams params = withoutTrackLoss();
  params.line_sigma_px = params.line_noise_px = 1;  // the structure turns lines by small angles only
  params.point_sigma_px = params.point_noise_px = 0.7;
  WindowFactors factors(window, params);
  factors.addAll(kParams, window.T_b_c());
  factors.add(makeBlockPrior(manifoldOf(BlockKey::kMotion), window.frames.front().motion,
                             Eigen::VectorXd::Constant(kMotionSize, 0.02)),
              {{BlockKey::kMotion, window.frames.front().id}});
  factors.add(makeMeanBiasPrior(Eigen::Vector3d::Zero(), kParams.initializer), {{BlockKey::kMeanBias, 0}});
  const double pair_sigma = kSigma_rad * std::sqrt(static_cast<double>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const BlockKey line{BlockKey::kLine, lines[i]};
    if (structure == Structure::kShared)
      factors.add(std::make_unique<SharedDirectionFactor>(1 / kSigma_rad), {line, {BlockKey::kDirection, kDirection}});
    if (structure == Structure::kPairs)
      for (std::size_t j = 0; j < i; ++j)
        factors.add(std::make_unique<ParallelLinesFactor>(1 / pair_sigma), {line, {BlockKey::kLine, lines[j]}});
  }
  return factors;
}

/// Covariances of poses (6x6) and of the lines' directions (2x2) in the tangent spaces at the window's state.
std::map<BlockKey, Eigen::MatrixXd> covariances(SlidingWindow& window, const std::vector<Factor>& factors,
                                                const std::vector<TrackId>& lines) {
  const NormalEquations eq = linearise(window, factors, {});
  const Eigen::VectorXd scale = eq.H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * eq.H * scale.asDiagonal();
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() * solved(scaled, Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols())) * scale.asDiagonal();
  std::map<BlockKey, Eigen::MatrixXd> result;
  for (std::size_t i = 0; i < eq.blocks.size(); ++i) {
    const Eigen::Index at = eq.offsets[i], size = eq.offsets[i + 1] - at;
    const Eigen::MatrixXd block = inverse.block(at, at, size, size);
    if (eq.blocks[i].kind == BlockKey::kPose) result[eq.blocks[i]] = block;
    for (const TrackId line : lines)
      if (eq.blocks[i] == BlockKey{BlockKey::kLine, line}) {
        Eigen::Matrix<double, 2, kLineTangent> turns;  // the direction is U e2: it moves with psi_x and psi_z
        turns << 1, 0, 0, 0, 0, 0, 1, 0;
        result[eq.blocks[i]] = turns * block * turns.transpose();
      }
  }
  return result;
}

void solveWell(SlidingWindow& window, const WindowFactors& factors) {
  for (int k = 0; k < 8; ++k) solveWindow(window, factors.factors(), kParams.calibration, {50});
}

TEST(PairwiseStructure, HasTheOptimumAndTheCovarianceOfASharedDirection) {
  SlidingWindow shared = noisyWindow();
  const std::vector<TrackId> lines = parallelLines(shared);
  ASSERT_GE(lines.size(), 4u);
  SlidingWindow pairs = shared, apart = shared;
  const WindowFactors by_direction = factorsOf(shared, lines, Structure::kShared),
                      by_pairs = factorsOf(pairs, lines, Structure::kPairs),
                      by_nothing = factorsOf(apart, lines, Structure::kNone);
  solveWell(shared, by_direction);
  solveWell(pairs, by_pairs);
  solveWell(apart, by_nothing);
  const auto of_shared = covariances(shared, by_direction.factors(), lines),
             of_pairs = covariances(pairs, by_pairs.factors(), lines),
             of_apart = covariances(apart, by_nothing.factors(), lines);
  ASSERT_EQ(of_shared.size(), lines.size() + shared.frames.size());

  const auto determinant = [](const Eigen::MatrixXd& m) { return Eigen::Matrix2d(m).determinant(); };
  double gain = 0, farthest_apart = 0;
  for (const TrackId id : lines) {
    const BlockKey key{BlockKey::kLine, id};
    const Eigen::MatrixXd &C = of_shared.at(key), &P = of_pairs.at(key);
    const double sigma = std::sqrt(C.trace());
    const Eigen::Vector3d d = directionOf(shared.lines.at(id)), p = directionOf(pairs.lines.at(id)),
                          a = directionOf(apart.lines.at(id));
    EXPECT_LT(d.cross(p).norm(), 0.01 * sigma) << "line " << id;
    // tangent spaces turn with U, whose axis along the line the two optima share to the same accuracy
    EXPECT_NEAR(P.trace(), C.trace(), 2e-3 * C.trace()) << "line " << id;
    EXPECT_NEAR(determinant(P), determinant(C), 4e-3 * determinant(C)) << "line " << id;
    gain = std::max(gain, std::sqrt(of_apart.at(key).trace() / C.trace()));
    farthest_apart = std::max(farthest_apart, d.cross(a).norm() / sigma);
  }
  EXPECT_GT(gain, 1.5) << "the constraint says something";
  EXPECT_GT(farthest_apart, 0.3);
  for (std::size_t k = 0; k < shared.frames.size(); ++k) {
    const BlockKey key{BlockKey::kPose, shared.frames[k].id};
    const Eigen::MatrixXd &C = of_shared.at(key), &P = of_pairs.at(key);
    Eigen::Matrix<double, kPoseTangent, 1> between;
    manifoldOf(key.kind)->Minus(pairs.block(key), shared.block(key), between.data());
    EXPECT_LT(std::sqrt((between.transpose() * solved(C, between)).value()), 0.01) << "frame " << k;
    EXPECT_LT((P - C).norm(), 2e-3 * C.norm()) << "frame " << k;
  }
}

TEST(PairwiseStructure, TheSolversOwnEquationsAreTheSameForTheStates) {
  SlidingWindow window = noisyWindow();
  const std::vector<TrackId> lines = parallelLines(window);
  ASSERT_GE(lines.size(), 4u);
  solveWell(window, factorsOf(window, lines, Structure::kShared));  // small angles
  const auto informationOn = [&](Structure structure, const BlockKey& last) {
    const WindowFactors factors = factorsOf(window, lines, structure);
    ReducedSystem system(window, factors.factors(), {}, {});
    system.linearise();
    const NormalEquations eq = system.eliminate();
    const auto end = std::find(eq.blocks.begin(), eq.blocks.end(), last);
    const Eigen::Index n = eq.offsets[static_cast<std::size_t>(end - eq.blocks.begin())], m = eq.H.rows() - n;
    // the shared direction, or the lines that pairs keep among the states, are the last blocks: eliminated here
    return Eigen::MatrixXd(eq.H.topLeftCorner(n, n) - eq.H.topRightCorner(n, m) * solved(eq.H.bottomRightCorner(m, m),
                                                                                         eq.H.bottomLeftCorner(m, n)));
  };
  const Eigen::MatrixXd shared = informationOn(Structure::kShared, {BlockKey::kDirection, kDirection}),
                        pairs = informationOn(Structure::kPairs, {BlockKey::kLine, lines.front()});
  ASSERT_EQ(shared.rows(), pairs.rows());
  const Eigen::VectorXd scale = shared.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd difference = scale.asDiagonal() * (shared - pairs) * scale.asDiagonal();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace lintel
