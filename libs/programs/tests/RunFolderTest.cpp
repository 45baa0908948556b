// SPDX-License-Identifier: BSD-3-Clause
#include "RunFolder.h"

#include <gmock/gmock.h>

#include "lintel/pipeline/Results.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string refusal(const std::string& path, bool overwrite) {
  try {
    const RunFolder folder(path, overwrite);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

OdometryPose pose(std::int64_t t_ns) {
  OdometryPose pose;
  pose.t_ns = t_ns;
  return pose;
}

TEST(RunFolder, TakesOneRunAtATime) {
  const test::TempFolder work;
  const std::string out = work / "out";
  {
    const RunFolder first(out, false);
    EXPECT_THAT(refusal(out, true), HasSubstr("another run is writing to it"));
  }
  EXPECT_FALSE(fs::exists(out)) << "made and left empty";
}

TEST(RunFolder, KeepsEarlierResultsUnlessTold) {
  const test::TempFolder work;
  work.write("out/trajectory.tum", "1\n");
  EXPECT_THAT(refusal(work / "out", false), HasSubstr("results of an earlier run"));
  EXPECT_EQ(refusal(work / "out", true), "");
  EXPECT_TRUE(fs::exists(work / "out/trajectory.tum"));
  work.write("killed/trajectory.partial.tum", "1\n");
  EXPECT_THAT(refusal(work / "killed", false), HasSubstr("trajectory.partial.tum of a run that was killed"));
  EXPECT_EQ(refusal(work / "killed", true), "");
}

TEST(RunFolder, RemovesWhatAKilledRunLeftHalfWritten) {
  const test::TempFolder work;
  work.write("out/.map.lintel.part-123", "half");
  work.write("out/notes.part-1", "not of a run");
  { const RunFolder folder(work / "out", false); }
  EXPECT_FALSE(fs::exists(work / "out/.map.lintel.part-123"));
  EXPECT_TRUE(fs::exists(work / "out/notes.part-1"));
}

TEST(RunFolder, ThatCannotBeMadeIsOneLine) {
  const test::TempFolder work;
  work.write("file", "");
  EXPECT_THAT(refusal(work / "file/out", false), HasSubstr("choose another folder"));
  EXPECT_THAT(refusal("/proc/out", false), HasSubstr("/proc/out: cannot be made"));
}

TEST(TrajectoryCheckpoint, AppendsThePosesSoFar) {
  const test::TempFolder work;
  TrajectoryCheckpoint checkpoint(work.path().string(), 1e9);
  const std::string path = work / "trajectory.partial.tum";
  checkpoint.add(pose(1000000000));
  EXPECT_FALSE(fs::exists(path)) << "not yet";
  checkpoint.flush();
  EXPECT_EQ(test::bytesOf(path), trajectoryText({pose(1000000000)}));
  checkpoint.add(pose(2000000000));
  checkpoint.flush();
  EXPECT_EQ(test::bytesOf(path), trajectoryText({pose(1000000000), pose(2000000000)}));
  checkpoint.remove();
  EXPECT_EQ(work.entries(), 0);
}

TEST(TrajectoryCheckpoint, AStartThatWasWrongIsTakenAway) {
  const test::TempFolder work;
  TrajectoryCheckpoint checkpoint(work.path().string(), 1e9);
  const std::string path = work / "trajectory.partial.tum";
  checkpoint.add(pose(1000000000));
  checkpoint.flush();
  checkpoint.withdrawStart();
  EXPECT_EQ(test::bytesOf(path), "");
  checkpoint.add(pose(2000000000));
  checkpoint.endStart();
  checkpoint.add(pose(3000000000));
  checkpoint.flush();
  checkpoint.add(pose(4000000000));
  checkpoint.withdrawStart();
  EXPECT_EQ(test::bytesOf(path), trajectoryText({pose(2000000000)}));
  checkpoint.add(pose(5000000000));
  checkpoint.flush();
  EXPECT_EQ(test::bytesOf(path), trajectoryText({pose(2000000000), pose(5000000000)}));
}

TEST(TrajectoryCheckpoint, WritesByItselfOnceTheTimeIsUp) {
  const test::TempFolder work;
  TrajectoryCheckpoint checkpoint(work.path().string(), 1e-9);
  checkpoint.add(pose(1));
  EXPECT_TRUE(fs::exists(work / "trajectory.partial.tum"));
  TrajectoryCheckpoint none(work.path().string(), 0);
  none.add(pose(1));
  none.flush();
  EXPECT_EQ(work.entries(), 0);
}

TEST(TrajectoryCheckpoint, ThatCannotBeWrittenLetsTheRunGoOn) {
  TrajectoryCheckpoint checkpoint("/nonexistent", 1e-9);
  checkpoint.add(pose(1));
  checkpoint.add(pose(2));
  EXPECT_THAT(checkpoint.fault(), HasSubstr("/nonexistent/trajectory.partial.tum: No such file"));
}

}  // namespace
}  // namespace lintel
