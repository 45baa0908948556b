// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lintel::test {

using Stamps = std::vector<std::int64_t>;

/// What `Times` (SampleTimes, FrameTimes) makes of stamps of which it has looked at the first ones.
template <typename Times>
Stamps evened(const Stamps& stamps, std::size_t looked_at) {
  Times times(Stamps(stamps.begin(), stamps.begin() + static_cast<std::ptrdiff_t>(std::min(looked_at, stamps.size()))));
  EXPECT_TRUE(times.found());
  Stamps out;
  for (const std::int64_t t_ns : stamps) {
    times.push(t_ns);
    while (const auto next = times.pop(false)) out.push_back(*next);
  }
  while (const auto next = times.pop(true)) out.push_back(*next);
  return out;
}

}  // namespace lintel::test
