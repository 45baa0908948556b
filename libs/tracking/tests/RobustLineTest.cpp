// SPDX-License-Identifier: BSD-3-Clause
#include "RobustLine.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

TEST(RobustLine, leavesOutliersOut) {
  const auto fit = fitRobustLine({{0, 0}, {10, 5.2}, {20, 9.9}, {30, 40}, {40, 20.1}, {50, 24.9}, {60, -12}}, 1.5);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->inliers, 5);
  EXPECT_FALSE(fit->inlier[3]);
  EXPECT_FALSE(fit->inlier[6]);
  EXPECT_NEAR(fit->line.direction().y() / fit->line.direction().x(), 0.5, 0.01);
}

TEST(RobustLine, refusesScatterAndTooFew) {
  EXPECT_FALSE(fitRobustLine({{0, 0}, {10, 30}, {20, -30}, {30, 55}, {40, -70}, {50, 5}}, 1.5));
  EXPECT_FALSE(fitRobustLine({{0, 0}, {10, 0}}, 1.5));
  EXPECT_FALSE(fitRobustLine({{1, 1}, {1, 1}, {1, 1}}, 1.5));
}

}  // namespace
}  // namespace lintel
