// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowSigma.h"

#include <gtest/gtest.h>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"

namespace lintel {
namespace {

using namespace test;

SlidingWindow flownWithNoise() {
  TrackSimulationParams tracks;
  tracks.duration_s = 4;
  tracks.max_points_per_frame = 40;
  SlidingWindow window = trueWindow(fly(ImuSimulatorParams{}, tracks), 10, 10);
  const EstimatorParams params;
  triangulatePoints(window, params.landmarks, 1);
  triangulateLines(window, params);
  return window;
}

TEST(WindowSigma, ObservationsNarrowThePriorAndNothingWidensIt) {
  const SlidingWindow window = flownWithNoise();
  EstimatorParams params;
  params.calibration.refine_readout = true;
  const WindowSigma all = windowSigma(window, params, window.T_b_c());
  const CalibrationSigma& sigma = all.calibration;
  const CalibrationParams& prior = params.calibration;
  const double slack = 1 + 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(sigma.p_b_c_m[axis], 0);
    EXPECT_LT(sigma.p_b_c_m[axis], prior.extrinsic_translation_sigma_m * slack);
    EXPECT_GT(sigma.R_b_c_rad[axis], 0);
    EXPECT_LT(sigma.R_b_c_rad[axis], prior.extrinsic_rotation_sigma_rad * slack);
  }
  EXPECT_LT(sigma.R_b_c_rad.minCoeff(), 0.9 * prior.extrinsic_rotation_sigma_rad) << "turning shows the rotation";
  EXPECT_LT(sigma.camera[0], prior.focal_sigma_px * slack);
  EXPECT_LT(sigma.camera[2], prior.centre_sigma_px * slack);
  EXPECT_GT(sigma.time_offset_s, 0);
  EXPECT_LT(sigma.time_offset_s, 0.7 * prior.time_offset_sigma_s) << "motion shows the time offset";
  EXPECT_GT(sigma.readout_s, 0);
  EXPECT_LT(sigma.readout_s, prior.readout_sigma_s * slack);
  EXPECT_GT(sigma.accelerometer_axes.minCoeff(), 0);
  EXPECT_LT(sigma.accelerometer_axes.diagonal().maxCoeff(), prior.axes_scale_sigma * slack);
  EXPECT_LT(sigma.accelerometer_axes.maxCoeff(), prior.axes_angle_sigma_rad * slack);
  EXPECT_GT(sigma.gyroscope_axes.minCoeff(), 0);
  EXPECT_LT(sigma.gyroscope_axes.maxCoeff(), prior.gyro_axes_scale_sigma * slack);
  EXPECT_GT(all.bias.gyro.minCoeff(), 0);
  EXPECT_LT(all.bias.gyro.maxCoeff(), 0.05) << "the turning of the images shows it";
  EXPECT_GT(all.bias.accel.minCoeff(), 0);
}

TEST(WindowSigma, WhatIsHeldHasNone) {
  const SlidingWindow window = flownWithNoise();
  EstimatorParams params;
  params.calibration.refine_extrinsics = params.calibration.refine_camera = params.calibration.refine_readout =
      params.calibration.refine_time_offset = params.calibration.refine_axes = false;
  const WindowSigma all = windowSigma(window, params, window.T_b_c());
  const CalibrationSigma& sigma = all.calibration;
  EXPECT_EQ(sigma.p_b_c_m.norm() + sigma.R_b_c_rad.norm() + sigma.camera.norm() + sigma.readout_s +
                sigma.time_offset_s + sigma.accelerometer_axes.norm() + sigma.gyroscope_axes.norm(),
            0);
}

}  // namespace
}  // namespace lintel
