// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelMap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "lintel/mapping/MapFile.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

using ::testing::HasSubstr;

class LintelMapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    LineMap map;
    for (std::uint64_t i = 0; i < 3; ++i) {
      MapLine line;
      line.id = i;
      line.segment_w.end = {1.0 + static_cast<double>(i), 0, 0};
      line.observations.resize(2 * i);
      map.lines.push_back(line);
    }
    writeMap(map, in("map.lintel"));
  }

  std::string in(const std::string& name) const { return folder_ / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(in(name)); }

  int run(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv{"lintel-map"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    out_.str(""), err_.str("");
    return runLintelMap(static_cast<int>(argv.size()), argv.data(), out_, err_);
  }

  test::TempFolder folder_;
  std::ostringstream out_, err_;
};

TEST_F(LintelMapTest, WritesTheFormThatTheExtensionNames) {
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.glb"), "-o", in("map.ply")}), 0);
  EXPECT_TRUE(exists("map.glb") && exists("map.ply"));
  EXPECT_THAT(out_.str(), HasSubstr("map.glb: 3 lines"));
  EXPECT_THAT(out_.str(), HasSubstr("f3d --point-size=2 --line-width=2 " + in("map.glb")));
  EXPECT_EQ(err_.str(), "");
}

TEST_F(LintelMapTest, HeedsEveryOption) {
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.csv"), "--min-observations", "3", "--min-length", "1.5", "--max-sigma",
                 "0.5", "--as", "tubes", "--radius", "0.1", "--colour", "height", "--layers", "lines,trajectory"}),
            0);
  EXPECT_THAT(out_.str(), HasSubstr("map.csv: 1 lines; 2 lines left out by the filters"));
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.csv"), "--quiet", "-w"}), 0);
  EXPECT_EQ(out_.str(), "");
}

TEST_F(LintelMapTest, ReplacesFilesOnlyWhenAsked) {
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.csv")}), 0);
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.ply"), "-o", in("map.csv")}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("map.csv: exists already; choose another name or add -w"));
  EXPECT_FALSE(exists("map.ply"));
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.csv"), "-w"}), 0);
}

TEST_F(LintelMapTest, WrongUseIsTwo) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({in("map.lintel")}), 2);
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.stl")}), 2);
  EXPECT_THAT(err_.str(), HasSubstr("glb"));
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.ply"), "--as", "dots"}), 2);
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.ply"), "--radius", "-1"}), 2);
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.ply"), "--layers", "lines,planes"}), 2);
  EXPECT_FALSE(exists("map.ply"));
}

TEST_F(LintelMapTest, BadFilesAreOneWithOneLine) {
  EXPECT_EQ(run({in("none.lintel"), "-o", in("map.ply")}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("none.lintel"));
  EXPECT_EQ(run({in("map.lintel"), "-o", in("none/map.ply")}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("none/map.ply"));
  std::filesystem::create_symlink("/dev/full", in("full.ply"));
  EXPECT_EQ(run({in("map.lintel"), "-o", in("full.ply")}), 1);
  const std::string text = err_.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

TEST_F(LintelMapTest, ALimitOfFileSizeIsAnErrorAndLeavesNothing) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 64;
  setrlimit(RLIMIT_FSIZE, &small);
  const int exit_code = run({in("map.lintel"), "-o", in("map.glb")});
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(exit_code, 1);
  EXPECT_THAT(err_.str(), HasSubstr("map.glb"));
  EXPECT_EQ(folder_.entries(), 1);
}

TEST_F(LintelMapTest, AnEmptyExportIsRefusedBeforeAnythingIsWritten) {
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.csv"), "-o", in("map.tum")}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("map.lintel: holds no trajectory, so " + in("map.tum") + " would be of no use"));
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.csv"), "--images", in("images"), "--recording", in("none")}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("holds no keyframes"));
  EXPECT_EQ(folder_.entries(), 1);
}

TEST_F(LintelMapTest, HelpHasExamples) {
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("lintel-map map.lintel -o map.glb"));
  EXPECT_EQ(run({"--version"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("lintel-map 0."));
}

TEST_F(LintelMapTest, WhatIsNotFiniteIsSaid) {
  LineMap map;
  map.lines.resize(2);
  map.lines[0].segment_w.end = {1, 2, 3};
  map.lines[1].id = 1;
  map.lines[1].segment_w.end = {std::nan(""), 2, 3};
  writeMap(map, in("map.lintel"));
  EXPECT_EQ(run({in("map.lintel"), "-o", in("map.ply")}), 0);
  EXPECT_THAT(err_.str(), HasSubstr("left out 1"));
}

}  // namespace
}  // namespace lintel
