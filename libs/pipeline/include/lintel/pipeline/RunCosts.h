// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// CPU time of this process so far, of all its threads and of the programs it has run [ms].
double processTimeMs();

/// What a run has cost: CPU time of its stages, those of every frame and those that come once.
class RunCosts {
 public:
  /// Books the time from its construction to its end, programs included, as a stage that comes once.
  class Once {
   public:
    Once(RunCosts& costs, std::string stage) : costs_(costs), stage_(std::move(stage)), start_ms_(processTimeMs()) {}
    ~Once() { costs_.once_ms.emplace_back(std::move(stage_), processTimeMs() - start_ms_); }
    Once(const Once&) = delete;
    Once& operator=(const Once&) = delete;

   private:
    RunCosts& costs_;
    std::string stage_;
    double start_ms_;
  };

  double wall_s = 0;
  std::vector<std::pair<std::string, double>> once_ms;

  /// (stage, CPU time in the whole run [ms]); the last is "rest": of `process_ms` what no stage accounts for.
  std::vector<std::pair<std::string, double>> breakdown(const OdometryStatistics& statistics, double process_ms) const;
};

}  // namespace lintel
