// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/Quantiles.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

using Values = std::vector<double>;

template <class Quantile>
double at(const Quantile& quantile, Values values) {
  return quantile(values);
}

TEST(Quantiles, TheDefinitionsDifferInTheRank) {
  const Values values{40, 10, 30, 20};
  EXPECT_EQ(at([](Values& v) { return upperQuantile(v, 0.5); }, values), 30);
  EXPECT_EQ(at([](Values& v) { return lowerQuantile(v, 0.5); }, values), 20);
  EXPECT_EQ(at([](Values& v) { return nearestQuantile(v, 0.4); }, values), 20);
  EXPECT_EQ(at([](Values& v) { return nearestQuantile(v, 0.6); }, values), 30);
  EXPECT_EQ(at([](Values& v) { return upperQuantile(v, 0.2); }, values), 10);
  EXPECT_EQ(at([](Values& v) { return upperQuantile(v, 0.25); }, values), 20) << "a quarter lies below it";
}

TEST(Quantiles, TheEndsAreTheSmallestAndTheLargest) {
  const Values values{3, 1, 2};
  EXPECT_EQ(at([](Values& v) { return upperQuantile(v, 0); }, values), 1);
  EXPECT_EQ(at([](Values& v) { return upperQuantile(v, 1); }, values), 3);
  EXPECT_EQ(at([](Values& v) { return lowerQuantile(v, 1); }, values), 3);
  EXPECT_EQ(at([](Values& v) { return nearestQuantile(v, 1); }, values), 3);
}

TEST(Quantiles, OfAnEvenNumberTheMedianIsTheMeanOfTwo) {
  EXPECT_EQ(at([](Values& v) { return median(v); }, {40, 10, 30, 20}), 25);
  EXPECT_EQ(at([](Values& v) { return upperMedian(v); }, {40, 10, 30, 20}), 30);
  EXPECT_EQ(at([](Values& v) { return median(v); }, {5, 1, 9}), 5);
  EXPECT_EQ(at([](Values& v) { return median(v); }, {7}), 7);
}

}  // namespace
}  // namespace lintel
