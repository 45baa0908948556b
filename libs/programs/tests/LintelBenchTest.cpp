// SPDX-License-Identifier: BSD-3-Clause
// lintel-bench with stand-ins for the programs it runs: quick, and they fail as they are told to.
#include "lintel/programs/LintelBench.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// Writes what lintel-vio would; `--set fault=…` makes it crash or complain; counts its calls.
constexpr const char* kVio = R"(#!/bin/sh
calls=$(dirname "$0")/calls; echo "$*" >> "$calls"
case $* in *fault=crash*) kill -SEGV $$ ;; *fault=complain*) echo "lintel-vio: no pose was found" >&2; exit 1 ;; esac
while [ "$1" != -o ]; do shift; done
x=0; while [ $x -lt 5 ]; do echo "$x.0 $x 0 0 0 0 0 1"; x=$((x + 1)); done > "$2/trajectory.tum"
echo '{"first_frame_ns": 0, "last_frame_ns": 4000000000, "frames": 5, "stages": {"tracking": {"mean_ms": '$$'}}}' > "$2/stats.json"
)";

/// An error that depends on the recording and the configuration only.
constexpr const char* kEval = R"(#!/bin/sh
case $* in */half/*) share=0.5 complete=false rmse=0.001 ;; *) share=0.95 complete=true rmse=0.012 ;; esac
case $* in */lines/*) rmse=0.010 ;; esac
while [ "$1" != --json ]; do shift; done
echo '{"trajectory": {"position_m": {"rmse": '$rmse', "max": 0.05}, "coverage_time": '$share', "complete": '$complete',
  "transform": {"scale": 1, "quaternion_xyzw": [0, 0, 0, 1], "translation_m": [0, 0, 0]}}}' > "$2"
)";

constexpr const char* kSim =
    "#!/bin/sh\necho sim >> \"$(dirname \"$0\")/calls\"\nmkdir -p \"$2/mav0/cam0\"\n"
    "mkdir -p \"$2/mav0/state_groundtruth_estimate0\"\n"
    "printf '#t\\n0,0,0,0,1,0,0,0\\n' > \"$2/mav0/state_groundtruth_estimate0/data.csv\"\n";

using test::bytesOf;

class LintelBenchProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "bin");
    for (const auto& [name, text] : {std::pair{"lintel-vio", kVio}, {"lintel-eval", kEval}, {"lintel-sim", kSim}}) {
      const std::string path = folder_ / (std::string("bin/") + name);
      std::ofstream(path) << text;
      fs::permissions(path, fs::perms::owner_all);
    }
    for (const char* name : {"half", "whole"}) {
      const fs::path mav0 = fs::path(folder_ / "data") / name / "mav0";
      fs::create_directories(mav0 / "cam0");
      fs::create_directories(mav0 / "state_groundtruth_estimate0");
      std::ofstream(mav0 / "state_groundtruth_estimate0/data.csv") << "#t\n0,0,0,0,1,0,0,0\n1000000000,1,0,0,1,0,0,0\n";
    }
    suite(
        "recordings: [half, whole, {name: made, sim: {scene: room}}]\n"
        "configurations:\n  - {name: points}\n  - {name: lines}\n");
  }
  void suite(const std::string& text) const { std::ofstream(folder_ / "suite.yaml") << text; }

  int run(const std::vector<std::string>& more, const std::string& out = "out") {
    const std::vector<std::string> all{folder_ / "suite.yaml", "-o",         folder_ / out,  "--recordings",
                                       folder_ / "data",       "--programs", folder_ / "bin"};
    std::vector<const char*> argv{"lintel-bench"};
    for (const std::string& word : all) argv.push_back(word.c_str());
    for (const std::string& word : more) argv.push_back(word.c_str());
    out_.str("");
    err_.str("");
    return runLintelBench(static_cast<int>(argv.size()), argv.data(), out_, err_);
  }
  /// Runs of lintel-vio or lintel-sim so far.
  long calls() const {
    const std::string text = bytesOf(folder_ / "bin/calls");
    return std::count(text.begin(), text.end(), '\n');
  }
  /// The tables that do not depend on the machine.
  std::string tables(const std::string& out) const {
    std::string all = bytesOf(folder_ / (out + "/results.json"));
    for (const char* name : {"accuracy", "coverage", "tracking", "relative"})
      for (const char* form : {".txt", ".csv"}) all += bytesOf(folder_ / (out + "/tables/" + name + form));
    return all;
  }

  test::TempFolder folder_;
  std::ostringstream out_, err_;
};

TEST_F(LintelBenchProgram, ASignalEndsTheRunsAndKeepsThoseThatAreDone) {
  ASSERT_EQ(run({"-j", "1", "--job", "whole/points/from0"}), 0) << err_.str();
  const std::string vio = folder_ / "bin/lintel-vio", works = bytesOf(vio);
  // the first of the two runs sends it, once: a second signal would be a wish to end at once
  std::ofstream(vio)
      << "#!/bin/sh\nmkdir \"$(dirname \"$0\")/sent\" 2>/dev/null && kill -TERM $PPID\nexec sleep 1000\n";
  EXPECT_EQ(run({"-j", "2", "-q"}), 143);
  EXPECT_THAT(err_.str(), HasSubstr("stopped by SIGTERM; what is done is kept"));
  EXPECT_FALSE(fs::exists(folder_ / "out/report.html"));
  std::ofstream(vio) << works;
  const long before = calls();
  EXPECT_EQ(run({"-j", "1"}), 0) << err_.str();
  EXPECT_GT(calls(), before);
}

TEST_F(LintelBenchProgram, RunsEverythingOnceAndWritesTheTables) {
  ASSERT_EQ(run({"-j", "2"}), 0) << err_.str();
  EXPECT_EQ(calls(), 6 + 1);
  EXPECT_THAT(out_.str(), HasSubstr("0.0120/0.0500"));
  for (const char* file : {"out/report.html", "out/results.json", "out/tables/accuracy.csv", "out/tables/timing.txt"})
    EXPECT_GT(fs::file_size(folder_ / file), 20u) << file;
  EXPECT_EQ(run({}), 0);
  EXPECT_EQ(calls(), 7);  // nothing was missing
}

TEST_F(LintelBenchProgram, HalfARecordingNeverWins) {
  ASSERT_EQ(run({"-q"}), 0) << err_.str();
  const std::string table = bytesOf(folder_ / "out/tables/accuracy.txt");
  EXPECT_THAT(table, HasSubstr("0.0010/0.0500 (50 %)"));
  EXPECT_THAT(table, Not(HasSubstr("0.0010/0.0500*")));
  EXPECT_THAT(table, HasSubstr("0.0100/0.0500*"));
}

TEST_F(LintelBenchProgram, AFailingRunIsIsolatedAndNamed) {
  suite(
      "recordings: [whole]\nconfigurations:\n  - {name: good}\n  - {name: crash, set: [fault=crash]}\n"
      "  - {name: complain, set: [fault=complain]}\n");
  EXPECT_EQ(run({}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("2 of 3 runs failed"));
  const std::string faults = bytesOf(folder_ / "out/tables/faults.txt");
  EXPECT_THAT(faults, HasSubstr("ended by signal 11"));
  EXPECT_THAT(faults, HasSubstr("no pose was found"));
  EXPECT_THAT(bytesOf(folder_ / "out/tables/accuracy.txt"), HasSubstr("0.0120/0.0500"));
  EXPECT_EQ(calls(), 3);
  EXPECT_EQ(run({}), 1);
  EXPECT_EQ(calls(), 3);  // a failure is a result …
  EXPECT_EQ(run({"--retry-failed"}), 1);
  EXPECT_EQ(calls(), 5);  // … unless asked otherwise
}

TEST_F(LintelBenchProgram, WhatAKilledRunLeftIsDoneAgain) {
  ASSERT_EQ(run({"-q"}), 0);
  const std::string before = tables("out");
  fs::rename(folder_ / "out/runs/whole/lines/from0", folder_ / "out/runs/whole/lines/from0.part");
  fs::remove(folder_ / "out/runs/whole/lines/from0.part/job.json");
  ASSERT_EQ(run({"-q"}), 0);
  EXPECT_EQ(calls(), 7 + 1);  // the one that was under way, nothing else
  EXPECT_EQ(tables("out"), before);
  EXPECT_FALSE(fs::exists(folder_ / "out/runs/whole/lines/from0.part"));
}

TEST_F(LintelBenchProgram, PrintedJobsOneByOneGiveTheSameTables) {
  ASSERT_EQ(run({"-q", "-j", "2"}), 0);
  ASSERT_EQ(run({"--print-jobs"}, "single"), 0);
  std::istringstream lines(out_.str());
  std::vector<std::string> ids;
  for (std::string line; std::getline(lines, line);) ids.push_back(line.substr(line.find("--job ") + 6));
  ASSERT_EQ(ids.size(), 6u);
  for (auto id = ids.rbegin(); id != ids.rend(); ++id) EXPECT_EQ(run({"-q", "--job", *id}, "single"), 0) << err_.str();
  ASSERT_EQ(run({"--collect", "-q"}, "single"), 0);
  EXPECT_EQ(tables("single"), tables("out"));
  EXPECT_EQ(run({"--print-jobs"}, "single"), 0);
  EXPECT_EQ(out_.str(), "");  // nothing is missing
}

TEST_F(LintelBenchProgram, AChangedSuiteRunsWhatChanged) {
  ASSERT_EQ(run({"-q"}), 0);
  suite("recordings: [half, whole]\nconfigurations:\n  - {name: points}\n  - {name: lines, set: [a=1]}\n");
  ASSERT_EQ(run({"-q"}), 0);
  EXPECT_EQ(calls(), 7 + 2);
}

TEST_F(LintelBenchProgram, WrongCommandLinesAreNamed) {
  EXPECT_EQ(run({"--collect", "--print-jobs"}), 2);
  EXPECT_EQ(run({"--job", "no/such/run"}), 2);
  EXPECT_EQ(run({"--collect"}, "empty"), 1);
  EXPECT_THAT(err_.str(), HasSubstr("holds no results of this suite"));
  suite("recordings: [nowhere]\nconfigurations: [{name: a}]\n");
  EXPECT_EQ(run({}), 1);
  EXPECT_THAT(err_.str(), HasSubstr("--recordings"));
}

}  // namespace
}  // namespace lintel
