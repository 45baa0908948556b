// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/RunStatistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lintel {
namespace {

TEST(StatisticsJson, SaysWhatTheRunCounted) {
  OdometryResult result;
  result.statistics.frames = 40;
  result.statistics.frames_with_pose = 30;
  result.statistics.resets = 1;
  result.statistics.failures = {"at 1.50 s: the IMU has a gap"};
  result.map.lines.resize(3);
  result.rig.camera.fx = 458.5;
  result.time_offset_s = 0.002;
  result.window_calibration.readout_s = 0.02;
  result.error = "cut off";
  result.lines_beside = 2;
  result.statistics.blind = {{3.5, 6}};
  for (int i = 0; i < 3; ++i) StageClock::Scope scope(result.statistics.tracking);
  result.statistics.mean_lines_direction_unknown = 7.5;
  result.window_calibration.camera.fx = 458.4;
  result.window_calibration.sigma = CalibrationSigma();
  result.window_calibration.sigma->camera[0] = 0.25;
  Rig given;
  given.camera.fx = 457;
  RunCosts costs;
  costs.wall_s = 2.0;
  costs.once_ms = {{"exports", 12.0}};
  const auto json = nlohmann::json::parse(statisticsJson(result, given, costs, {"an image is missing"}));
  EXPECT_EQ(json["frames"], 40);
  EXPECT_EQ(json["frames_with_pose"], 30);
  EXPECT_EQ(json["resets"], 1);
  EXPECT_EQ(json["reset_reasons"][0], "at 1.50 s: the IMU has a gap");
  EXPECT_EQ(json["blind_s"][0][0], 3.5);
  EXPECT_EQ(json["blind_s"][0][1], 6);
  EXPECT_EQ(json["map_lines"], 3);
  EXPECT_EQ(json["map_lines_beside"], 2);
  EXPECT_EQ(json["calibration"]["intrinsics_px"][0], 458.5);
  EXPECT_EQ(json["calibration"]["time_offset_s"], 0.002);
  EXPECT_EQ(json["calibration"]["window"]["readout_s"], 0.02);
  EXPECT_EQ(json["calibration"]["given"]["intrinsics_px"][0], 457);
  EXPECT_EQ(json["calibration"]["window"]["intrinsics_px"][0], 458.4);
  EXPECT_EQ(json["calibration"]["window"]["sigma"]["intrinsics_px"][0], 0.25);
  EXPECT_EQ(json["mean_lines_degenerate_by_reason"]["direction_unknown"], 7.5);
  EXPECT_EQ(json["frames_per_s"], 20);
  EXPECT_EQ(json["cpu_ms"]["exports"], 12);
  double stages_ms = 0;
  for (const auto& [stage, ms] : json["cpu_ms"].items())
    if (stage != "whole process") stages_ms += ms.get<double>();
  EXPECT_NEAR(stages_ms, json["cpu_ms"]["whole process"], 1e-6) << "nothing is left out";
  EXPECT_NEAR(json["cpu_ms_per_frame"].get<double>() * 40, json["cpu_ms"]["whole process"], 1e-6);
  EXPECT_EQ(json["stages"]["tracking"]["count"], 3);
  EXPECT_EQ(json["stages"]["estimation"]["count"], 0);
  EXPECT_GE(json["stages"]["tracking"]["max_ms"], json["stages"]["tracking"]["median_ms"]);
  EXPECT_EQ(json["warnings"][0], "an image is missing");
  EXPECT_EQ(json["ended_early"], "cut off");
}

TEST(StatisticsJson, AnEmptyRunIsNoDivisionByZero) {
  const auto json = nlohmann::json::parse(statisticsJson({}, {}, {}, {}));
  EXPECT_EQ(json["frames"], 0);
  EXPECT_EQ(json["frames_per_s"], 0);
  EXPECT_EQ(json["cpu_ms_per_frame"], 0);
}

TEST(PeakMemory, IsThatOfAProcess) {
  EXPECT_GT(peakMemoryMb(), 1);
  EXPECT_LT(peakMemoryMb(), 1e5);
}

}  // namespace
}  // namespace lintel
