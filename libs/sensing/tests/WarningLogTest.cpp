// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "Warnings.h"

namespace lintel {
namespace {

TEST(WarningLogTest, ShowsAFewOfAKindAndCountsTheRest) {
  WarningLog log;
  for (int i = 0; i < 1000; ++i) log.add({Fault::ImuStamp, "stamp " + std::to_string(i)});
  log.add({Fault::Image, "image"});
  EXPECT_THAT(log.lines(), testing::ElementsAre("image", "stamp 0", "stamp 1", "stamp 2",
                                                "and 997 more IMU time stamps out of order"));
}

TEST(WarningLogTest, IsEmptyAtFirst) { EXPECT_TRUE(WarningLog().lines().empty()); }

}  // namespace
}  // namespace lintel
