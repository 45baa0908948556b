// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/StartMemory.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

FrameTracks tracksAt(std::int64_t t_ns) {
  FrameTracks tracks;
  tracks.t_ns = t_ns;
  return tracks;
}

TEST(StartMemory, KeepsTheLastFramesAndThoseBetweenThem) {
  StartMemory memory;
  for (std::int64_t t_ns = 0; t_ns < 100; ++t_ns)
    if (t_ns % 2 == 0) {
      memory.add(tracksAt(t_ns), {}, 5);
    } else {
      memory.addSkipped(t_ns, t_ns);
    }
  ASSERT_EQ(memory.inputs().size(), 5u);
  EXPECT_EQ(memory.inputs().front().tracks.t_ns, 90);
  EXPECT_EQ(memory.inputs().back().tracks.t_ns, 98);
  EXPECT_EQ(memory.skippedBetween(0, 100), (std::vector<std::int64_t>{91, 93, 95, 97, 99}));
  EXPECT_EQ(memory.skippedBetween(91, 97), (std::vector<std::int64_t>{93, 95})) << "both ends are not between";
  memory.clear();
  EXPECT_TRUE(memory.inputs().empty());
  EXPECT_TRUE(memory.skippedBetween(0, 100).empty());
}

/// As those are that a buffer has left out to become longer.
TEST(StartMemory, FramesBetweenOthersMayComeInAnyOrder) {
  StartMemory memory;
  for (const std::int64_t t_ns : {3, 7, 5, 9, 4}) memory.addSkipped(t_ns, 0);
  EXPECT_EQ(memory.skippedBetween(3, 10), (std::vector<std::int64_t>{4, 5, 7, 9}));
}

TEST(StartMemory, KeepsFramesBetweenThoseOfTheWindowAsWell) {
  StartMemory memory;
  memory.addSkipped(1, 0);
  memory.add(tracksAt(10), {}, 1);
  memory.addSkipped(11, 0);
  EXPECT_EQ(memory.skippedBetween(-1, 100), (std::vector<std::int64_t>{1, 11})) << "the window begins at 0";
  memory.addSkipped(12, 5);
  EXPECT_EQ(memory.skippedBetween(-1, 100), (std::vector<std::int64_t>{11, 12}));
}

}  // namespace
}  // namespace lintel
