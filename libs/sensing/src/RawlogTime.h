// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/Clock.h>

#include <cstdint>
#include <limits>

#include "TimeTicks.h"

namespace lintel {

constexpr std::int64_t kTicksFrom1601To1970 = 116444736000000000;

/// By integers: MRPT's conversions go through double, which holds only 256 ns today.
inline mrpt::Clock::time_point toRawlogTime(std::int64_t t_ns) {
  return mrpt::Clock::time_point(mrpt::Clock::duration(t_ns / kTick_ns + kTicksFrom1601To1970));
}

/// -1 for times before 1970, "no time" among them, and for those beyond what nanoseconds can hold (the year 2262).
inline std::int64_t fromRawlogTime(const mrpt::Clock::time_point& time) {
  const std::int64_t ticks = time.time_since_epoch().count();
  if (ticks < kTicksFrom1601To1970) return -1;
  const std::int64_t since_1970 = ticks - kTicksFrom1601To1970;
  return since_1970 > std::numeric_limits<std::int64_t>::max() / kTick_ns ? -1 : since_1970 * kTick_ns;
}

}  // namespace lintel
