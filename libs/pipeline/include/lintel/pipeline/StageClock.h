// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>
#include <vector>

#include "lintel/core/ThreadTime.h"

namespace lintel {

/// CPU time of one stage on its thread, a value a frame [ms]: a figure that other work on the machine disturbs little.
class StageClock {
 public:
  /// Measures from construction to destruction.
  class Scope {
   public:
    explicit Scope(StageClock& clock) : clock_(clock), start_ms_(threadTimeMs()) {}
    ~Scope() { clock_.ms_.push_back(threadTimeMs() - start_ms_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StageClock& clock_;
    double start_ms_;
  };

  /// For what was measured elsewhere.
  void add(double ms) { ms_.push_back(ms); }

  const std::vector<double>& ms() const { return ms_; }
  double sumMs() const { return std::accumulate(ms_.begin(), ms_.end(), 0.0); }

 private:
  std::vector<double> ms_;
};

}  // namespace lintel
