// SPDX-License-Identifier: BSD-3-Clause
#include "solver/WindowSolver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "DenseReference.h"
#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "solver/ReducedSystem.h"

namespace lintel {
namespace {

using namespace test;

SlidingWindow disturbedWindow() {
  TrackSimulationParams tracks;
  tracks.duration_s = 2;
  tracks.max_points_per_frame = 30;
  tracks.max_lines_per_frame = 8;
  tracks.point_noise_px = tracks.line_noise_px = 0.5;
  SlidingWindow window = trueWindow(fly(ImuSimulatorParams{}, tracks), 10, 6);
  triangulatePoints(window, kParams.landmarks, 1);
  triangulateLines(window, kParams);
  for (std::size_t k = 0; k < window.frames.size(); ++k)
    window.frames[k].pose.head<3>() += 0.01 * Eigen::Vector3d(1, -1, static_cast<double>(k % 3));
  return window;
}

WindowFactors everything(const SlidingWindow& window, const FactorParams& params, const MotionBlock& first_motion) {
  WindowFactors factors(window, params);
  factors.addGauge();
  factors.addCalibrationPriors(kParams.calibration, window.T_b_c());
  factors.addAxesPrior(kParams.calibration);
  factors.addImu();
  factors.add(makeBlockPrior(manifoldOf(BlockKey::kMotion), first_motion,
                             Eigen::VectorXd::Constant(kMotionSize, 0.02)),  // half a second does not show the scale
              {{BlockKey::kMotion, window.frames.front().id}});
  factors.addPoints();
  factors.addLines(kParams.degeneracy);
  return factors;
}

WindowFactors everything(const SlidingWindow& window, const FactorParams& params = kParams.factors) {
  return everything(window, params, window.frames.front().motion);
}

TEST(WindowSolver, FindsTheMinimumThatCeresFinds) {
  SlidingWindow window = disturbedWindow(), reference = window;
  const WindowFactors factors = everything(window, withoutTrackLoss()),
                      others = everything(reference, withoutTrackLoss());
  const SolveSummary summary = solveWindow(window, factors.factors(), kParams.calibration, {50});
  const double cost = solveWithCeres(reference, others.factors());
  ASSERT_TRUE(std::isfinite(summary.final_cost));
  EXPECT_GT(summary.initial_cost, 2 * cost);
  EXPECT_LT(summary.final_cost, 1.01 * cost) << "it stops when a step brings less than a thousandth";
  for (std::size_t k = 0; k < window.frames.size(); ++k)
    EXPECT_LT((window.frames[k].T_w_b().p - reference.frames[k].T_w_b().p).norm(), 2e-3) << k;
}

/// The largest error of a position [m] when every third point slides by 0.4 px with each frame, as a corner does that
/// two edges at different depths make.
double errorWithSlidingPoints(const FactorParams& params) {
  SlidingWindow window = disturbedWindow();
  const SlidingWindow truth = window;
  for (auto& [id, track] : window.points)
    if (id % 3 == 0)
      for (PointSighting& s : track.sightings) s.px.x() += 0.4 * static_cast<double>(s.frame);
  const WindowFactors factors = everything(window, params);
  solveWindow(window, factors.factors(), kParams.calibration, {50});
  double error_m = 0;
  for (std::size_t k = 1; k < window.frames.size(); ++k) {
    const Eigen::Vector3d moved = window.frames[k].T_w_b().p - window.frames[0].T_w_b().p,
                          true_move = truth.frames[k].T_w_b().p - truth.frames[0].T_w_b().p;
    error_m = std::max(error_m, (moved - true_move - 0.01 * Eigen::Vector3d(0, 0, -static_cast<double>(k % 3))).norm());
  }
  return error_m;
}

TEST(WindowSolver, TracksThatSlideLoseTheirWeightAsWholes) {
  EXPECT_LT(errorWithSlidingPoints(forWhiteNoise().factors), 0.7 * errorWithSlidingPoints(withoutTrackLoss()));
}

/// The median of the points' levels in a solved window whose tracks have 0.5 px of noise, which is `told_px`.
double solvedLevel(double told_px, double scale) {
  SlidingWindow window = disturbedWindow();
  window.noise_scales.points = scale;
  FactorParams params = withoutTrackLoss();
  params.point_sigma_px = params.point_noise_px = told_px;
  const WindowFactors factors = everything(window, params);
  solveWindow(window, factors.factors(), kParams.calibration, {50});
  std::vector<double> levels = solveWindow(window, factors.factors(), kParams.calibration, {1}).levels.points;
  EXPECT_GT(levels.size(), 10u);
  std::nth_element(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2), levels.end());
  return levels[levels.size() / 2];
}

TEST(WindowSolver, LevelsSayByHowMuchTheNoiseIsOff) {
  EXPECT_NEAR(solvedLevel(0.5, 1), 1, 0.25);
  EXPECT_NEAR(solvedLevel(0.25, 1), 4, 1);
  EXPECT_NEAR(solvedLevel(0.25, 2), 1, 0.25) << "the window's scale counts";
}

TEST(WindowSolver, WhatIsNotRefinedIsAConstantAndTheRestIsNot) {
  EstimatorParams params;
  params.calibration.refine_camera = params.calibration.refine_readout = params.calibration.refine_extrinsics = false;
  SlidingWindow window = disturbedWindow();
  const PoseBlock extrinsics = window.extrinsics;
  WindowFactors factors(window, params.factors);
  factors.addAll(params, window.T_b_c());
  solveWindow(window, factors.factors(), params.calibration, {50});
  EXPECT_EQ(window.extrinsics, extrinsics);
  const Eigen::VectorXd camera = window.correction.head<kTimeOffsetAt>();
  EXPECT_EQ(camera, Eigen::VectorXd::Zero(kTimeOffsetAt)) << "not a nanometre";
  EXPECT_NE(window.correction[kTimeOffsetAt], 0);
  EXPECT_LT(std::abs(window.correction[kTimeOffsetAt]), 0.01);
  // and the equations know it: no number in them is that of a constant
  ReducedSystem system(window, factors.factors(), {}, {{BlockKey::kExtrinsics, 0}});
  system.linearise();
  EXPECT_LT(system.eliminate().H.diagonal().maxCoeff(), 1e15);
}

TEST(WindowSolver, AxesAreHeldWhereTheyAreNotRefined) {
  for (const bool refined : {true, false}) {
    EstimatorParams params;
    params.calibration.refine_axes = refined;
    SlidingWindow window = disturbedWindow();
    WindowFactors factors(window, params.factors);
    factors.addAll(params, window.T_b_c());
    solveWindow(window, factors.factors(), params.calibration, {50});
    EXPECT_EQ(window.axes.norm() > 0, refined);
  }
}

CalibrationParams exactCalibration() {
  CalibrationParams calibration;
  calibration.refine_extrinsics = calibration.refine_camera = calibration.refine_readout = false;
  calibration.refine_time_offset = calibration.refine_axes = false;
  return calibration;
}

/// A camera that moves by 18 m past things 50 to 110 m away, all of it smaller by a third about the first frame. What
/// speaks against it is a prior on the last frame's position, 0.5 m strong.
struct WronglyScaledWindow {
  static constexpr double kScale = 2.0 / 3, kLength_m = 18;
  const FactorParams params = withoutTrackLoss();
  SlidingWindow window;
  WindowFactors factors;

  WronglyScaledWindow() : window(made()), factors(window, params) {
    const auto pose = manifoldOf(BlockKey::kPose);
    const PoseBlock first = window.frames.front().pose;
    PoseBlock last = window.frames.back().pose;
    last[0] = kLength_m;
    const auto sigmas = [](double position_m, double rotation_rad) {
      Eigen::VectorXd sigma(kPoseTangent);
      sigma << Eigen::Vector3d::Constant(position_m), Eigen::Vector3d::Constant(rotation_rad);
      return sigma;
    };
    factors.add(makeBlockPrior(pose, first, sigmas(1e-4, 1e-4)), {{BlockKey::kPose, window.frames.front().id}});
    factors.add(makeBlockPrior(pose, last, sigmas(0.5, 1)), {{BlockKey::kPose, window.frames.back().id}});
    factors.addPoints();
    factors.addLines(kParams.degeneracy);
  }

  static SlidingWindow made() {
    constexpr int kFrames = 10;
    std::vector<Pose> poses;
    for (int k = 0; k < kFrames; ++k)
      poses.push_back(at(kLength_m * k / (kFrames - 1), k % 2 == 0 ? 0 : 0.8, 0.3 * (k % 3)));
    SlidingWindow window = windowAt(poses);
    for (int k = 0; k < kFrames; ++k) {
      for (int i = 0; i < 30; ++i)
        seePoint(window, static_cast<TrackId>(i), k, {7.0 * (i % 6) - 10, 9.0 * (i % 5) - 18, 50 + 2.0 * i});
      for (int i = 0; i < 6; ++i)
        seeLine(window, static_cast<TrackId>(i), k,
                {{6.0 * i - 12, -15, 60 + 8.0 * i}, {6.0 * i - 9, 15, 64 + 5.0 * i}});
    }
    for (WindowFrame& frame : window.frames) frame.pose.head<3>() *= kScale;
    triangulatePoints(window, kParams.landmarks, 1);
    triangulateLines(window, kParams);
    return window;
  }

  double length_m() const { return (window.frames.back().T_w_b().p - window.frames.front().T_w_b().p).norm(); }
};

TEST(WindowSolver, FindsAScaleThatImagesDoNotShowInFewSteps) {
  WronglyScaledWindow far;
  const double wanted_m = far.made().frames.back().T_w_b().p.norm() / far.kScale;
  EXPECT_LT(far.length_m(), 0.7 * wanted_m);
  solveWindow(far.window, far.factors.factors(), exactCalibration(), {8, 0, false, 1e-9, 1e-8});
  EXPECT_NEAR(far.length_m() / wanted_m, 1, 0.01);
}

TEST(WindowSolver, StopsAtTheLimitOfIterations) {
  SlidingWindow window = disturbedWindow();
  const WindowFactors factors = everything(window);
  EXPECT_EQ(solveWindow(window, factors.factors(), kParams.calibration, {1}).iterations, 1);
}

/// Distance of two windows' states in the standard deviations that the residuals give them.
double statesApart(SlidingWindow& window, const SlidingWindow& other, const std::vector<Factor>& factors) {
  ReducedSystem system(window, factors, {}, {});
  system.linearise();
  const NormalEquations equations = system.eliminate();
  Eigen::VectorXd apart(equations.H.rows());
  SlidingWindow copy = other;
  for (std::size_t i = 0; i < equations.blocks.size(); ++i) {
    const BlockKey& key = equations.blocks[i];
    manifoldOf(key.kind)->Minus(copy.block(key), window.block(key), apart.data() + equations.offsets[i]);
  }
  return std::sqrt(apart.dot(equations.H * apart));
}

TEST(WindowSolver, StatesHaveSettledBeforeTheLandmarks) {
  const FactorParams params = kParams.factors;
  SlidingWindow window = disturbedWindow();
  const WindowFactors before = everything(window, params);
  solveWindow(window, before.factors(), kParams.calibration, {50});
  for (auto& [id, track] : window.points)  // as in a flight: good states, new landmarks that are not yet in place
    if (id % 4 == 0) track.point.head<3>() *= 1.5;
  SlidingWindow settled = window;
  const WindowFactors factors = everything(window, params), same = everything(settled, params);
  const SolveSummary all = solveWindow(window, factors.factors(), kParams.calibration, {50});
  const SolveSummary some = solveWindow(settled, same.factors(), kParams.calibration, {50, 0.3});
  EXPECT_LT(some.iterations, all.iterations);
  EXPECT_LT(statesApart(window, settled, factors.factors()), 0.3);
}

TEST(WindowSolver, NeverEndsWorseThanItBegan) {
  SlidingWindow window = disturbedWindow();
  for (auto& [id, track] : window.points)  // far from anything sensible
    if (id % 3 == 0) track.point.head<3>() = -track.point.head<3>();
  const WindowFactors factors = everything(window);
  const SolveSummary summary = solveWindow(window, factors.factors(), kParams.calibration, {30});
  EXPECT_LE(summary.final_cost, summary.initial_cost);
  for (const WindowFrame& frame : window.frames) EXPECT_TRUE(frame.pose.allFinite() && frame.motion.allFinite());
}

}  // namespace
}  // namespace lintel
