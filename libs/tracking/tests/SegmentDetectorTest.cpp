// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/tracking/SegmentDetector.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "TestImages.h"

namespace lintel {
namespace {

using namespace testing;

/// How far the ends of `edge` are from the line through two pixels.
double distanceTo(const EdgeSegment& edge, const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  const Eigen::Vector2f d = (b - a).normalized(), n(-d.y(), d.x());
  return static_cast<double>(std::max(std::abs(n.dot(edge.start_px - a)), std::abs(n.dot(edge.end_px - a))));
}

class SegmentDetectorTest : public ::testing::Test {
 protected:
  SegmentDetectorTest() { rig_.camera.lens = {}; }

  std::vector<EdgeSegment> detect(const Scene& scene) {
    return SegmentDetector(rig_, params_).detect(*renderScene(rig_, scene, 0).image);
  }

  Rig rig_ = testRig();
  SegmentParams params_;
};

TEST_F(SegmentDetectorTest, BothEdgesOfAStripWithTheBrightSideOnTheRight) {
  const auto found = detect(strips({{{-0.3, 0}, {0.3, 0}, 0.05}}));  // 180 px long, 30 px wide, in the middle
  for (const float y : {145.0f, 175.0f}) {
    const auto edge = std::find_if(found.begin(), found.end(), [&](const EdgeSegment& e) {
      return distanceTo(e, {0, y}, {480, y}) < 0.6;
    });
    ASSERT_NE(edge, found.end()) << y;
    EXPECT_NEAR((edge->end_px - edge->start_px).norm(), 180, 10);
    EXPECT_NEAR(edge->dark, 60, 5);
    EXPECT_NEAR(edge->bright, 180, 5);
    EXPECT_EQ(edge->end_px.x() > edge->start_px.x(), y < 160) << "the strip is below its upper edge";
  }
}

TEST_F(SegmentDetectorTest, AShortFaintEdgeIsFound) {
  const auto found = detect(strips({{{0, 0}, {0.1, 0.02}, 0.04}}, {}, 100, 112));  // 30 px, 12 grey levels
  EXPECT_GE(found.size(), 2U);
  for (const EdgeSegment& edge : found) EXPECT_LT((edge.end_px - edge.start_px).norm(), 40);
}

TEST_F(SegmentDetectorTest, NoEdgeTwiceAndLongerOnesFirst) {
  const auto found = detect(strips({{{-0.3, -0.2}, {0.3, 0.1}, 0.03}, {{-0.2, 0.3}, {0.1, 0.35}, 0.02}}));
  ASSERT_GE(found.size(), 4U);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE((found[j].end_px - found[j].start_px).norm(), (found[i].end_px - found[i].start_px).norm());
      const Eigen::Vector2f middle = 0.5f * (found[i].start_px + found[i].end_px);
      const bool beside = (middle - 0.5f * (found[j].start_px + found[j].end_px)).norm() < 10;
      EXPECT_FALSE(beside && distanceTo(found[i], found[j].start_px, found[j].end_px) < 1);
    }
}

TEST_F(SegmentDetectorTest, AFlatImageHasNone) {
  EXPECT_TRUE(detect([](const Eigen::Vector2d&) { return 90; }).empty());
}

TEST_F(SegmentDetectorTest, WhatIsShorterThanAskedForIsLeftOut) {
  params_.min_length_px = 100;
  for (const EdgeSegment& edge : detect(strips({{{-0.3, -0.2}, {0.3, 0.1}, 0.03}, {{0, 0.2}, {0.1, 0.2}, 0.02}})))
    EXPECT_GE((edge.end_px - edge.start_px).norm(), 50) << "of the size of image that the parameter is meant for";
}

TEST_F(SegmentDetectorTest, AParameterOutOfRangeIsNamed) {
  params_.gradient_threshold = 0;
  EXPECT_THROW(SegmentDetector(rig_, params_), std::invalid_argument);
}

}  // namespace
}  // namespace lintel
