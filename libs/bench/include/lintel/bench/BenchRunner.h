// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "lintel/bench/BenchJobs.h"

namespace lintel {

/// How a job ended.
struct JobOutcome {
  bool already_done = false;
  bool failed = false;
  std::string text;  ///< one line: what came out, or why it failed
};

/// Whether a job's result is there and is what the suite asks for now. With `retry_failed` a failure is no result.
bool isDone(const BenchJob& job, bool retry_failed = false);

/// Runs jobs: lintel-sim where the recording has to be made, lintel-vio, lintel-eval, each a process of its own, so
/// that a crash ends one run only. What a job leaves appears at once when all of it is there. Jobs of one suite may run
/// at the same time, on machines that share the folder.
class BenchRunner {
 public:
  /// `programs`: folder of the other programs. `vio_threads`: of each lintel-vio and lintel-sim. `stop`: asked while a
  /// program runs, may be empty; true ends it, and the job has no result.
  BenchRunner(const BenchSuite& suite, std::filesystem::path out, std::filesystem::path programs, int vio_threads,
              std::function<bool()> stop = {});

  /// Throws std::runtime_error on what no job could go on with (a full disk).
  JobOutcome run(const BenchJob& job, bool retry_failed = false) const;

 private:
  std::string makeRecording(const BenchJob& job) const;
  std::string odometry(const BenchJob& job, const std::filesystem::path& part) const;
  std::string evaluate(const BenchJob& job, const std::filesystem::path& part) const;
  std::string evaluateTrajectory(const BenchJob& job, const std::filesystem::path& part, const std::string& trajectory,
                                 const std::string& json, bool with_map) const;
  std::string runProgram(const std::vector<std::string>& words, const std::filesystem::path& log) const;

  const BenchSuite& suite_;
  std::filesystem::path out_, programs_;
  int vio_threads_;
  std::function<bool()> stop_;
};

}  // namespace lintel
