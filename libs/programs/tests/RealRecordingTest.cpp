// SPDX-License-Identifier: BSD-3-Clause
// lintel-vio on sixteen seconds of the real EuRoC flight MH_01, which are not part of the project.
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

TEST(RealRecording, TrajectoryAndMapOfAHandheldStart) {
  const char* folder = std::getenv("LINTEL_TEST_DATA");
  const std::string input = std::string(folder ? folder : LINTEL_SOURCE_DIR "/../shared/data") + "/MH_01_easy_16s";
  if (!std::filesystem::exists(input)) GTEST_SKIP() << input << " is absent; set LINTEL_TEST_DATA";
  const TempFolder work;
  const std::string out = work / "out";
  const ProgramRun run = runVio({input, "-o", out, "-c", eurocConfig(), "--export", "none", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const auto statistics = nlohmann::json::parse(bytesOf(out + "/stats.json"));
  EXPECT_EQ(statistics["frames"], 320);
  EXPECT_GE(statistics["frames_with_pose"], 280);
  EXPECT_EQ(statistics["resets"], 0);
  EXPECT_LT(statistics["peak_memory_mb"], 600);

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

}  // namespace
}  // namespace lintel
