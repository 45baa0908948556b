// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <time.h>

namespace lintel {

/// CPU time of the calling thread so far [ms]: a measure that other work on the machine disturbs little.
inline double threadTimeMs() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

}  // namespace lintel
