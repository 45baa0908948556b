// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/RunCosts.h"

#include <sys/resource.h>

namespace lintel {

double processTimeMs() {
  double sum_ms = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& t : {usage.ru_utime, usage.ru_stime})
      sum_ms += 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  }
  return sum_ms;
}

std::vector<std::pair<std::string, double>> RunCosts::breakdown(const OdometryStatistics& s, double process_ms) const {
  std::vector<std::pair<std::string, double>> stages{{"decoding", s.decoding.sumMs()},
                                                     {"tracking", s.tracking.sumMs()},
                                                     {"estimation", s.estimation.sumMs()},
                                                     {"mapping", s.mapping.sumMs()},
                                                     {"loops", s.loops.sumMs()},
                                                     {"map fitting", s.map_fitting.sumMs()},
                                                     {"refinement", s.refinement.sumMs()},
                                                     {"edges", s.edges.sumMs()},
                                                     {"densification", s.densification.sumMs()}};
  stages.insert(stages.end(), once_ms.begin(), once_ms.end());
  double booked_ms = 0;
  for (const auto& stage : stages) booked_ms += stage.second;
  stages.emplace_back("rest", process_ms - booked_ms);
  return stages;
}

}  // namespace lintel
