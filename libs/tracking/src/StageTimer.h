// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// Adds the time from its construction to its end to a stage.
class StageTimer {
 public:
  StageTimer(FrontEndStatistics& statistics, const std::string& stage)
      : times_(statistics.stages[stage]), start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() {
    const std::chrono::duration<float, std::milli> elapsed = std::chrono::steady_clock::now() - start_;
    times_.ms.push_back(elapsed.count());
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes& times_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace lintel
