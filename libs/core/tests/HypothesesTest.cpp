// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/Hypotheses.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

TEST(Hypotheses, TheLikelierIsTakenAndItsSigmaCoversTheOther) {
  const auto [a, sigma_a] = likelierAndSigma(0.75, 1, 2, 4, 1);
  EXPECT_EQ(a, 1);
  EXPECT_NEAR(sigma_a, std::sqrt(0.75 * 4 + 0.25 * (1 + 9)), 1e-12);
  const auto [b, sigma_b] = likelierAndSigma(0.25, 1, 2, 4, 1);
  EXPECT_EQ(b, 4);
  EXPECT_NEAR(sigma_b, std::sqrt(0.75 * 1 + 0.25 * (4 + 9)), 1e-12);
  EXPECT_EQ(likelierAndSigma(1, 1, 2, 400, 100), std::make_pair(1.0, 2.0));
}

TEST(Hypotheses, ADensityIsThatOfTheNormalDistribution) {
  EXPECT_NEAR(normalDensity(0, 1), 0.3989422804, 1e-10);
  EXPECT_NEAR(normalDensity(-3, 1.5), 0.0359939777, 1e-10);
}

}  // namespace
}  // namespace lintel
