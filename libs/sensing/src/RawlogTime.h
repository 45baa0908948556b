// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/Clock.h>

#include <cstdint>

#include "TimeTicks.h"

namespace lintel {

constexpr std::int64_t kTicksFrom1601To1970 = 116444736000000000;

/// By integers: MRPT's conversions go through double, which holds only 256 ns today.
inline mrpt::Clock::time_point toRawlogTime(std::int64_t t_ns) {
  return mrpt::Clock::time_point(mrpt::Clock::duration(t_ns / kTick_ns + kTicksFrom1601To1970));
}

inline std::int64_t fromRawlogTime(const mrpt::Clock::time_point& time) {
  return (static_cast<std::int64_t>(time.time_since_epoch().count()) - kTicksFrom1601To1970) * kTick_ns;
}

}  // namespace lintel
