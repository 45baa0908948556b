// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/ThreadTime.h"
#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// Adds the CPU time of this thread from its construction to its end to a stage.
class StageTimer {
 public:
  StageTimer(FrontEndStatistics& statistics, const std::string& stage)
      : times_(statistics.stages[stage]), start_ms_(threadTimeMs()) {}
  ~StageTimer() { times_.ms.push_back(static_cast<float>(threadTimeMs() - start_ms_)); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes& times_;
  double start_ms_;
};

}  // namespace lintel
