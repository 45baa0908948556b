// SPDX-License-Identifier: BSD-3-Clause
#include "window/AdaptiveWeights.h"

#include <gtest/gtest.h>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "solver/WindowSolver.h"

namespace lintel {
namespace {

using namespace test;

/// The scales after a solve of a window whose tracks have the given noise.
ResidualScales scalesWith(double point_noise_px, double line_noise_px) {
  EstimatorParams params;
  params.factors.point_sigma_px = params.factors.line_sigma_px = 1;
  TrackSimulationParams tracks;
  tracks.duration_s = 3;
  tracks.max_points_per_frame = 80;
  tracks.max_lines_per_frame = 40;
  tracks.point_noise_px = point_noise_px;
  tracks.line_noise_px = line_noise_px;
  SlidingWindow window = trueWindow(fly(perfectImu(), tracks), 4, 10);
  for (auto& [id, track] : window.lines)
    for (LineSighting& s : track.sightings) s.sigma_px = 1;
  triangulatePoints(window, params.landmarks, 1);
  triangulateLines(window, params);
  WindowFactors factors(window, params.factors);
  factors.addGauge();
  factors.addCalibrationPriors(params.calibration, window.T_b_c());
  factors.addImu();
  factors.addPoints();
  params.degeneracy.lines = "drop";
  factors.addLines(params.degeneracy);
  solveWindow(window, factors.factors(), params.calibration, {10});
  return residualScales(window, factors.factors());
}

TEST(AdaptiveWeights, ScalesAreThoseOfTheNoise) {
  const ResidualScales scales = scalesWith(0.5, 1.5);
  EXPECT_NEAR(scales.points, 0.5, 0.1);
  EXPECT_NEAR(scales.lines, 1.5, 0.3);
}

TEST(AdaptiveWeights, AFewResidualsSayNothing) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0.5, 0, 0)});
  seePoint(window, 1, 0, {0, 0, 4}, {3, 3});
  seePoint(window, 1, 1, {0, 0, 4});
  PointTrack& track = window.points[1];
  track.point = PointBlock(0, 0, 4, 1).normalized();
  track.triangulated = true;
  const FactorParams params;
  WindowFactors factors(window, params);
  factors.addPoints();
  ASSERT_EQ(factors.factors().size(), 2u);
  const ResidualScales scales = residualScales(window, factors.factors());
  EXPECT_EQ(scales.points, 1);
  EXPECT_EQ(scales.lines, 1);
}

TEST(AdaptiveWeights, SigmasMoveSlowlyAndNotFarFromTheConfiguredOnes) {
  FactorParams configured, now;
  const double point = configured.point_sigma_px, line = configured.line_sigma_px;
  adaptSigmas({1.1, 0.9}, configured, now);
  EXPECT_NEAR(now.point_sigma_px, point * std::pow(1.1, 0.1), 1e-12);
  EXPECT_NEAR(now.line_sigma_px, line * std::pow(0.9, 0.1), 1e-12);
  for (int i = 0; i < 100; ++i) adaptSigmas({5, 0.1}, configured, now);
  EXPECT_DOUBLE_EQ(now.point_sigma_px, 2 * point);
  EXPECT_DOUBLE_EQ(now.line_sigma_px, 0.5 * line);
}

}  // namespace
}  // namespace lintel
