// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/ParallelFor.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace lintel {
namespace {

TEST(ParallelFor, DoesEveryIndexOnceOnAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<int> times(1000, 0);
    std::size_t done = 0;
    parallelFor(
        times.size(), threads, [&](std::size_t i) { ++times[i]; },
        [&](std::size_t n) {
          EXPECT_EQ(n, done + 1);
          done = n;
        });
    EXPECT_EQ(times, std::vector<int>(1000, 1)) << threads;
    EXPECT_EQ(done, 1000U);
  }
}

TEST(ParallelFor, TheFirstExceptionEndsItAndIsThrown) {
  for (const int threads : {1, 3}) {
    std::vector<int> times(100000, 0);
    const auto work = [&](std::size_t i) {
      ++times[i];
      if (i == 5) throw std::runtime_error("five");
    };
    try {
      parallelFor(times.size(), threads, work);
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "five");
    }
    EXPECT_EQ(times.back(), 0);
  }
}

TEST(ParallelFor, NothingToDo) {
  parallelFor(0, 2, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace lintel
