// SPDX-License-Identifier: BSD-3-Clause
// Simulated recording → lintel-vio → lintel-map → lintel-eval, as a user runs them.
// Environment: LINTEL_PROGRAMS (folder of the programs), LINTEL_CONFIG (euroc.yaml), LINTEL_E2E_FOLDER (to work in).
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

namespace lintel {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr) throw std::runtime_error(std::string(name) + " is not set");
  return value;
}

std::string shellWord(const fs::path& path) { return "'" + path.string() + "'"; }

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Pipeline : public ::testing::Test {
 protected:
  /// Makes the recording and the map that all tests look at.
  static void SetUpTestSuite() {
    folder_ = environment("LINTEL_E2E_FOLDER");
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    sim_exit_ = run("lintel-sim", "--scene room --duration 12 --seed 3 -o " + shellWord(recording()));
    if (sim_exit_ == 0) vio_exit_ = runVio(recording(), "out");
  }

  void SetUp() override {
    ASSERT_EQ(sim_exit_, 0) << bytesOf(folder_ / "lintel-sim.err");
    ASSERT_EQ(vio_exit_, 0) << bytesOf(folder_ / "lintel-vio.err");
  }

  /// Runs a program; its output goes to PROGRAM.out and PROGRAM.err in the work folder.
  static int run(const std::string& program, const std::string& arguments) {
    const std::string command = shellWord(fs::path(environment("LINTEL_PROGRAMS")) / program) + " " + arguments +
                                " > " + shellWord(folder_ / (program + ".out")) + " 2> " +
                                shellWord(folder_ / (program + ".err"));
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static int runVio(const fs::path& recording, const std::string& out, const std::string& options = "") {
    return run("lintel-vio", shellWord(recording) + " -o " + shellWord(folder_ / out) + " -c " +
                                 shellWord(environment("LINTEL_CONFIG")) + " " + options);
  }
  static fs::path recording() { return folder_ / "recording"; }
  static fs::path truth(const std::string& sensor) { return recording() / "mav0" / sensor / "data.csv"; }

  /// Figures of lintel-eval for a run's trajectory and map.
  static nlohmann::json evaluate(const std::string& out) {
    const fs::path json = folder_ / (out + ".json");
    EXPECT_EQ(run("lintel-eval", "--trajectory " + shellWord(folder_ / out / "trajectory.tum") + " --groundtruth " +
                                     shellWord(truth("state_groundtruth_estimate0")) + " --map " +
                                     shellWord(folder_ / out / "map.lintel") + " --lines " +
                                     shellWord(truth("lines0")) + " --json " + shellWord(json)),
              0)
        << bytesOf(folder_ / "lintel-eval.err");
    return nlohmann::json::parse(bytesOf(json));
  }

  static void expectSameRun(const std::string& out) {
    for (const char* file : {"trajectory.tum", "map.lintel"}) {
      EXPECT_FALSE(bytesOf(folder_ / out / file).empty());
      EXPECT_TRUE(bytesOf(folder_ / "out" / file) == bytesOf(folder_ / out / file)) << file << " differs in " << out;
    }
  }

  static inline fs::path folder_;
  static inline int sim_exit_ = -1, vio_exit_ = -1;
};

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

TEST_F(Pipeline, RawlogGivesTheSameBytes) {
  ASSERT_EQ(run("euroc2rawlog", "-w -i " + shellWord(recording()) + " -o " + shellWord(folder_ / "recording.rawlog")),
            0)
      << bytesOf(folder_ / "euroc2rawlog.err");
  ASSERT_EQ(runVio(folder_ / "recording.rawlog", "out_rawlog"), 0) << bytesOf(folder_ / "lintel-vio.err");
  EXPECT_TRUE(bytesOf(folder_ / "out/trajectory.tum") == bytesOf(folder_ / "out_rawlog/trajectory.tum"));
}

TEST_F(Pipeline, ThreadsGiveTheSameBytes) {
  ASSERT_EQ(runVio(recording(), "out_1", "--threads 1"), 0) << bytesOf(folder_ / "lintel-vio.err");
  ASSERT_EQ(runVio(recording(), "out_2", "--threads 2"), 0) << bytesOf(folder_ / "lintel-vio.err");
  expectSameRun("out_1");
  expectSameRun("out_2");
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
