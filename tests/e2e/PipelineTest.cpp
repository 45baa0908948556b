// SPDX-License-Identifier: BSD-3-Clause
// Simulated recording → lintel-vio → lintel-map → lintel-eval, as a user runs them.
#include "Pipeline.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST_F(Pipeline, FollowsTheTruth) {
  const auto trajectory = evaluate("out")["trajectory"];
  EXPECT_LE(trajectory["position_m"]["rmse"], 0.05);
  EXPECT_GE(trajectory["coverage_time"], 0.8);
  EXPECT_NEAR(trajectory["scale"], 1, 0.03);
}

TEST_F(Pipeline, MapsLinesWhereEdgesAre) {
  const auto lines = evaluate("out")["lines"];
  EXPECT_GE(lines["lines"], 40);
  EXPECT_GE(lines["precision"][2], 0.7);  // within 10 cm
  EXPECT_GE(lines["all_matched"]["count"], 30);
  EXPECT_LE(lines["all_matched"]["direction_median_rad"], 0.05);
}

TEST_F(Pipeline, ExportsEveryForm) {
  for (const std::string form : {"glb", "obj", "ply", "3Dscene", "csv", "png"}) {
    const fs::path file = folder_ / ("map." + form);
    EXPECT_EQ(run("lintel-map", shellWord(folder_ / "out/map.lintel") + " -o " + shellWord(file)), 0)
        << bytesOf(folder_ / "lintel-map.err");
    EXPECT_TRUE(fs::exists(file) && fs::file_size(file) > 0) << file;
  }
}

TEST_F(Pipeline, RawlogAndOneThreadGiveTheSameBytes) {
  ASSERT_EQ(run("euroc2rawlog", "-w -i " + shellWord(recording()) + " -o " + shellWord(folder_ / "recording.rawlog")),
            0)
      << bytesOf(folder_ / "euroc2rawlog.err");
  ASSERT_EQ(runVio(folder_ / "recording.rawlog", "out_rawlog", "--threads 1 --export none"), 0)
      << bytesOf(folder_ / "lintel-vio.err");
  for (const char* file : {"trajectory.tum", "trajectory_refined.tum", "map.lintel"}) {
    EXPECT_FALSE(bytesOf(folder_ / "out" / file).empty());
    EXPECT_TRUE(bytesOf(folder_ / "out" / file) == bytesOf(folder_ / "out_rawlog" / file)) << file;
  }
}

TEST_F(Pipeline, ABadRecordingIsOneLineAndLeavesNothing) {
  EXPECT_EQ(runVio(folder_ / "absent", "out_absent"), 1);
  const std::string complaint = bytesOf(folder_ / "lintel-vio.err");
  EXPECT_THAT(complaint, StartsWith("lintel-vio: "));
  EXPECT_THAT(complaint, HasSubstr("absent"));
  EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 1);
  EXPECT_FALSE(fs::exists(folder_ / "out_absent" / "map.lintel"));
}

}  // namespace
}  // namespace lintel
