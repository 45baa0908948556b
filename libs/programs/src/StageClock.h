// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <time.h>

#include <vector>

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

  const std::vector<double>& ms() const { return ms_; }

 private:
  static double threadTimeMs() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }

  std::vector<double> ms_;
};

}  // namespace lintel
