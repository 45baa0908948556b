// SPDX-License-Identifier: BSD-3-Clause
// lintel-vio on real recordings, which are not part of the project: sixteen seconds of the EuRoC flight MH_01, and a
// hand-held RealSense whose calibration leaves distortion, rolling shutter and clocks out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "VioTestRuns.h"
#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/mapping/MapFile.h"

namespace lintel {
namespace {

using namespace test;

std::string recording(const std::string& name) {
  const char* folder = std::getenv("LINTEL_TEST_DATA");
  return std::string(folder ? folder : LINTEL_SOURCE_DIR "/../shared/data") + "/" + name;
}

TEST(RealRecording, TrajectoryAndMapOfAHandheldStart) {
  const std::string input = recording("MH_01_easy_16s");
  if (!std::filesystem::exists(input)) GTEST_SKIP() << input << " is absent; set LINTEL_TEST_DATA";
  const TempFolder work;
  const std::string out = work / "out";
  const ProgramRun run = runVio({input, "-o", out, "-c", eurocConfig(), "--export", "none", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const auto statistics = nlohmann::json::parse(bytesOf(out + "/stats.json"));
  EXPECT_EQ(statistics["frames"], 320);
  EXPECT_GE(statistics["frames_with_pose"], 280);
  EXPECT_EQ(statistics["resets"], 0);
#ifndef __SANITIZE_ADDRESS__  // which keeps what is freed
  EXPECT_LT(statistics["peak_memory_mb"], 600);
#endif

  const TrajectoryErrors errors = evaluateTrajectory(
      readTrajectory(out + "/trajectory.tum"), readTrajectory(input + "/mav0/state_groundtruth_estimate0/data.csv"));
  EXPECT_LE(errors.position_m.rmse, 0.012);

  const LineMap map = readMap(out + "/map.lintel");
  const auto well_seen = std::count_if(map.lines.begin(), map.lines.end(),
                                       [](const MapLine& line) { return line.observations.size() >= 5; });
  EXPECT_GE(well_seen, 60);
  RecordProperty("ate_um", static_cast<int>(1e6 * errors.position_m.rmse));
  RecordProperty("well_seen_lines", static_cast<int>(well_seen));
  std::cout << statistics["frames_with_pose"] << " poses, ATE " << errors.position_m.rmse << " m, " << well_seen
            << " of " << map.lines.size() << " lines seen at least 5 times, " << statistics["peak_memory_mb"]
            << " MB\n";
}

/// Short tracks of poor images in slow motion: from the closed form alone many adjustments end in wrong minima.
TEST(RealRecording, ARoughlyKnownRigStartsInMotion) {
  const std::string input = recording("l515_handheld_25s");
  if (!std::filesystem::exists(input)) GTEST_SKIP() << input << " is absent; set LINTEL_TEST_DATA";
  const TempFolder work;
  const std::string out = work / "out";
  const ProgramRun run =
      runVio({input, "-o", out, "--from", "6", "--to", "18", "--no-refine", "--export", "none", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto statistics = nlohmann::json::parse(bytesOf(out + "/stats.json"));
  EXPECT_LT(statistics["first_pose_s"], 6);
  TrajectoryErrorParams params;
  params.max_difference_s = 0.02;
  const TrajectoryErrors errors = evaluateTrajectory(readTrajectory(out + "/trajectory.tum"),
                                                     readTrajectory(input + "/reference/openvins.tum"), params);
  EXPECT_LE(errors.position_m.rmse, 0.05);
}

}  // namespace
}  // namespace lintel
