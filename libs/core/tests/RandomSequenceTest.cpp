// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/RandomSequence.h"

#include <gtest/gtest.h>

#include <vector>

namespace lintel {
namespace {

TEST(RandomSequence, IsTheSameEverywhere) {
  RandomSequence sequence(1);
  // (6364136223846793005 + 1442695040888963407) mod 2^64 >> 33, by hand
  EXPECT_EQ(sequence.below(std::size_t{1} << 31), 908834774u);
  RandomSequence again(1);
  EXPECT_EQ(again.below(1000), 774u);
}

TEST(RandomSequence, DrawsEveryNumberAboutAsOften) {
  RandomSequence sequence(7);
  std::vector<int> drawn(10);
  for (int i = 0; i < 10000; ++i) ++drawn.at(sequence.below(10));
  for (const int times : drawn) EXPECT_NEAR(times, 1000, 120);  // four standard deviations
}

}  // namespace
}  // namespace lintel
