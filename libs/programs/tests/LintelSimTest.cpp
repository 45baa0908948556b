// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelSim.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

class LintelSimTest : public testing::Test {
 protected:
  int run(std::vector<std::string> arguments) {
    std::vector<const char*> argv{"lintel-sim"};
    for (const std::string& a : arguments) argv.push_back(a.c_str());
    out_.str("");
    err_.str("");
    return runLintelSim(static_cast<int>(argv.size()), argv.data(), out_, err_);
  }
  std::string folder() const { return folder_ / "recording"; }

  test::TempFolder folder_;
  std::ostringstream out_, err_;
};

TEST_F(LintelSimTest, WritesARecordingAndSaysWhere) {
  ASSERT_EQ(run({"-o", folder() + "/", "--duration", "0.1", "--threads", "1"}), 0) << err_.str();
  EXPECT_TRUE(fs::exists(folder() + "/mav0/lines0/data.csv"));
  EXPECT_TRUE(fs::exists(folder() + "/mav0/scene0/scene.ply"));
  EXPECT_FALSE(fs::exists(folder() + ".part"));
  EXPECT_NE(out_.str().find("mav0/lines0/data.csv"), std::string::npos);
}

TEST_F(LintelSimTest, ReplacesOnlyRecordingsAndOnlyWhenTold) {
  fs::create_directories(folder());
  std::ofstream(folder() + "/letter.txt") << "keep me";
  EXPECT_EQ(run({"-o", folder(), "--duration", "0.1"}), 1);
  EXPECT_NE(err_.str().find("-w"), std::string::npos);
  EXPECT_EQ(run({"-o", folder(), "--duration", "0.1", "-w"}), 1);  // not one of ours
  EXPECT_TRUE(fs::exists(folder() + "/letter.txt"));
  fs::remove(folder() + "/letter.txt");
  fs::create_directories(folder() + "/mav0");
  EXPECT_EQ(run({"-o", folder(), "--duration", "0.1", "-w", "--quiet"}), 0) << err_.str();
  EXPECT_EQ(out_.str() + err_.str(), "");
}

TEST_F(LintelSimTest, WrongCommandLinesAreUsageErrors) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"-o", folder(), "--scene", "cellar"}), 2);
  EXPECT_EQ(run({"-o", folder(), "--duration", "-3"}), 2);
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(LintelSimTest, AMissingTrajectoryIsNamed) {
  EXPECT_EQ(run({"-o", folder(), "--trajectory", folder_ / "nothing.tum"}), 1);
  EXPECT_NE(err_.str().find("nothing.tum"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder() + ".part"));
}

}  // namespace
}  // namespace lintel
