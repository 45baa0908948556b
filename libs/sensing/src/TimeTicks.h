// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace lintel {

// A rawlog's time stamps tick at 100 ns. EuRoC's nanoseconds are cut to the same ticks, by the same integers, when a
// folder is read directly: only so do both routes see identical times and give identical results, also after
// rawlog-edit has renamed files or labels. The 0..99 ns lost are far below the cameras' and the IMU's own clocks.
constexpr std::int64_t kTick_ns = 100;

/// `t_ns` (>= 0) cut to the tick at or before it.
constexpr std::int64_t cutToTick(std::int64_t t_ns) { return t_ns - t_ns % kTick_ns; }

/// Seconds with 9 decimals, exact, for messages.
inline std::string secondsText(std::int64_t t_ns) {
  const std::string fraction = std::to_string(std::abs(t_ns % 1000000000));
  return (t_ns < 0 ? "-" : "") + std::to_string(std::abs(t_ns / 1000000000)) + "." +
         std::string(9 - fraction.size(), '0') + fraction + " s";
}

}  // namespace lintel
