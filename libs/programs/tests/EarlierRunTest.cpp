// SPDX-License-Identifier: BSD-3-Clause
#include "EarlierRun.h"

#include <gtest/gtest.h>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

using State = EarlierRun::State;

const char* const kWhole =
    R"({"command": ["a", "-o", "b"], "ended_early": "", "frames_with_pose": 3, "not_to_be_trusted": "", "partial": false})";

TEST(EarlierRun, IsNoneInAFolderWithoutResults) {
  const test::TempFolder work;
  EXPECT_EQ(EarlierRun::in(work / "nothing").state, State::kNone);
  work.write("out/notes.txt", "mine");
  EXPECT_EQ(EarlierRun::in(work / "out").state, State::kNone);
}

TEST(EarlierRun, IsWholeWithItsStatistics) {
  const test::TempFolder work;
  work.write("out/trajectory.tum", "1\n");
  work.write("out/config.yaml", "features: points\n");
  work.write("out/stats.json", kWhole);
  const EarlierRun run = EarlierRun::in(work / "out");
  EXPECT_EQ(run.state, State::kWhole);
  EXPECT_EQ(run.verdict, "");
  EXPECT_EQ(run.command, (std::vector<std::string>{"a", "-o", "b"}));
  EXPECT_EQ(run.configuration, "features: points\n");
  work.write("out/stats.json", std::string(kWhole).replace(std::string(kWhole).find(": 3"), 3, ": 0"));
  EXPECT_EQ(EarlierRun::in(work / "out").verdict, "no pose was found");
}

TEST(EarlierRun, IsBrokenWhenItDidNotEndByItself) {
  const test::TempFolder work;
  work.write("out/trajectory.tum", "1\n");
  EXPECT_EQ(EarlierRun::in(work / "out").state, State::kBroken) << "killed before stats.json, which is written last";
  work.write("out/stats.json", std::string(kWhole).replace(std::string(kWhole).find("false"), 5, "true"));
  EXPECT_EQ(EarlierRun::in(work / "out").state, State::kBroken);
  work.write("out/stats.json", "{\"frames\": 3}");
  EXPECT_EQ(EarlierRun::in(work / "out").reason, "its stats.json is of another version");
  work.write("out/stats.json", "half a fi");
  EXPECT_EQ(EarlierRun::in(work / "out").state, State::kBroken);
  work.write("out/stats.json", kWhole);
  work.write("out/trajectory.partial.tum", "1\n");
  EXPECT_EQ(EarlierRun::in(work / "out").reason, "it was killed") << "a later run, which was to write over the first";
}

TEST(EarlierRun, EssentialArgumentsDecideWhatIsComputed) {
  const char* const argv[] = {"lintel-vio", "rec", "--resume", "-o", "out", "-w", "--overwrite", "-q", "--quiet"};
  EXPECT_EQ(essentialArguments(9, argv), (std::vector<std::string>{"rec", "-o", "out"}));
  EXPECT_TRUE(essentialArguments(0, argv).empty());
}

}  // namespace
}  // namespace lintel
