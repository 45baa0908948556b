// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Segment.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lintel {
namespace {

const Segment3 kSegment{{0, 0, 0}, {2, 0, 0}};

TEST(Segment, DistanceBesideAndBeyondTheEnds) {
  EXPECT_DOUBLE_EQ(distanceToSegment({1, 1, 0}, kSegment), 1);
  EXPECT_DOUBLE_EQ(distanceToSegment({-3, 4, 0}, kSegment), 5);
  EXPECT_DOUBLE_EQ(distanceToSegment({3, 0, 1}, kSegment), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(distanceToSegment({2, 0, 0}, kSegment), 0);
}

TEST(Segment, DistanceToASegmentOfNoLength) {
  EXPECT_DOUBLE_EQ(distanceToSegment({1, 2, 5}, {{1, 2, 3}, {1, 2, 3}}), 2);
}

TEST(Segment, LengthDirectionMidpoint) {
  const Segment3 segment{{1, 1, 1}, {1, 4, 5}};
  EXPECT_DOUBLE_EQ(segment.length(), 5);
  EXPECT_TRUE(segment.direction().isApprox(Eigen::Vector3d(0, 0.6, 0.8), 1e-15));
  EXPECT_EQ(segment.midpoint(), Eigen::Vector3d(1, 2.5, 3));
}

TEST(Segment, LineAngleHasNoSign) {
  EXPECT_DOUBLE_EQ(lineAngle({1, 0, 0}, {-3, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(lineAngle({1, 0, 0}, {2, 2, 0}), M_PI / 4);
  EXPECT_DOUBLE_EQ(lineAngle({1, 0, 0}, {-2, 2, 0}), M_PI / 4);
  EXPECT_DOUBLE_EQ(lineAngle({0, 1, 0}, {0, 0, 4}), M_PI / 2);
}

TEST(Segment, LineAngleIsExactNearZero) { EXPECT_DOUBLE_EQ(lineAngle({1, 0, 0}, {1, 1e-12, 0}), 1e-12); }

TEST(Segment2, SeparationByHand) {
  const Segment2 a{{10, 20}, {110, 20}};
  EXPECT_DOUBLE_EQ(separation(a, {{10, 25}, {110, 25}}), 5);
  EXPECT_DOUBLE_EQ(separation(a, {{110, 15}, {10, 15}}), 5) << "whichever way it runs";
  EXPECT_DOUBLE_EQ(separation(a, {{60, 20}, {160, 30}}), 2.5) << "mean over what lies side by side: 0 to 5";
  EXPECT_LT(separation(a, {{100, 25}, {200, 25}}), 0) << "a tenth side by side";
  EXPECT_LT(separation(a, {{50, 0}, {50, 40}}), 0) << "across";
}

}  // namespace
}  // namespace lintel
