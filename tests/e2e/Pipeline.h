// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace lintel {

namespace fs = std::filesystem;

inline std::string environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr) throw std::runtime_error(std::string(name) + " is not set");
  return value;
}

inline std::string shellWord(const fs::path& path) { return "'" + path.string() + "'"; }

inline std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Simulated recording → lintel-vio, as a user runs them: made once for all tests of the program.
/// Environment: LINTEL_PROGRAMS (folder of the programs), LINTEL_CONFIG (euroc.yaml), LINTEL_E2E_FOLDER (to work in).
class Pipeline : public ::testing::Test {
 protected:
  /// Makes the recording and the map that all tests look at.
  static void SetUpTestSuite() {
    folder_ = environment("LINTEL_E2E_FOLDER");
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    sim_exit_ = run("lintel-sim", "--scene room --duration 8 --seed 3 -o " + shellWord(recording()));
    if (sim_exit_ == 0) vio_exit_ = runVio(recording(), "out", "--threads 2");
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

  static inline fs::path folder_;
  static inline int sim_exit_ = -1, vio_exit_ = -1;
};

}  // namespace lintel
