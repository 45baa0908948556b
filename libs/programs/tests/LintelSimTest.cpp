// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelSim.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include "lintel/core/FolderLock.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

class LintelSimTest : public testing::Test {
 protected:
  int run(const std::vector<std::string>& arguments) {
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

TEST_F(LintelSimTest, StoppedByASignalItLeavesNothing) {
  const auto before = std::signal(SIGTERM, [](int) {});
  std::atomic<bool> ended{false};
  std::thread sender([&] {
    while (!ended && !fs::exists(folder() + ".part/mav0/cam0")) std::this_thread::yield();
    kill(getpid(), SIGTERM);
  });
  EXPECT_EQ(run({"-o", folder(), "--duration", "30", "--threads", "1", "-q"}), 143);
  ended = true;
  sender.join();
  std::signal(SIGTERM, before);
  EXPECT_EQ(err_.str(), "lintel-sim: stopped by SIGTERM, nothing was written\n");
  EXPECT_EQ(folder_.entries(), 0);
}

TEST_F(LintelSimTest, OneRunAtATimeMakesAFolder) {
  fs::create_directories(folder() + ".part");
  const FolderLock other(folder() + ".part");
  EXPECT_EQ(run({"-o", folder(), "--duration", "0.1"}), 1);
  EXPECT_NE(err_.str().find("another run is writing to it"), std::string::npos) << err_.str();
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
