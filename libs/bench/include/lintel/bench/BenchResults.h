// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lintel/bench/BenchJobs.h"

namespace lintel {

/// What one job has left.
struct BenchRun {
  bool found = false;
  std::string fault;                                             ///< why there is no result; empty: there is one
  nlohmann::ordered_json evaluation, evaluation_refined, stats;  ///< null where a file is missing

  bool ok() const { return found && fault.empty(); }
  /// Figures by path, e.g. number(evaluation, "/trajectory/position_m/rmse"); NaN where there is none.
  static double number(const nlohmann::ordered_json& json, const std::string& path);
};

/// The repetitions of one recording with one configuration.
class BenchCell {
 public:
  void add(BenchRun run) { runs_.push_back(std::move(run)); }

  std::size_t runs() const { return runs_.size(); }
  std::size_t missing() const;
  std::size_t failed() const;
  std::string firstFault() const;
  bool anyOk() const;
  /// Whether every run that has a ground truth covers enough of it.
  bool complete() const;
  /// Median over the runs that have the figure; NaN if none.
  double evaluation(const std::string& path) const { return median(&BenchRun::evaluation, path); }
  double refined(const std::string& path) const { return median(&BenchRun::evaluation_refined, path); }
  double stats(const std::string& path) const { return median(&BenchRun::stats, path); }
  const std::vector<BenchRun>& all() const { return runs_; }

 private:
  double median(nlohmann::ordered_json BenchRun::*part, const std::string& path) const;

  std::vector<BenchRun> runs_;
};

/// All that the jobs of a suite have left: cell(recording, configuration).
class BenchResults {
 public:
  BenchResults(const BenchSuite& suite, const std::vector<BenchJob>& jobs);

  const BenchCell& cell(std::size_t recording, std::size_t configuration) const {
    return cells_[recording * configurations_ + configuration];
  }
  /// (job, run) in the order of the jobs.
  const std::vector<std::pair<BenchJob, BenchRun>>& runs() const { return runs_; }
  std::size_t missing() const;

 private:
  std::size_t configurations_;
  std::vector<BenchCell> cells_;
  std::vector<std::pair<BenchJob, BenchRun>> runs_;
};

}  // namespace lintel
