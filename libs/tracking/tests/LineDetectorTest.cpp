// SPDX-License-Identifier: BSD-3-Clause
#include "LineDetector.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "TestImages.h"

namespace lintel {
namespace {

using testing::Strip;

/// The two detectors, on images whose lines are known.
class LineDetectorTest : public ::testing::TestWithParam<const char*> {
 protected:
  LineDetectorTest() {
    rig_.camera.lens = {};
    params_.detector = GetParam();
  }

  std::vector<ImageLine> detect(const testing::Scene& scene) {
    const LineCamera camera(rig_.camera);
    ImagePyramid pyramid(PyramidParams(), params_.window_px);
    pyramid.push(*testing::renderScene(rig_, scene, 0).image);
    return LineDetector(camera, params_).detectLong(pyramid);
  }

  Rig rig_ = testing::testRig();
  LineTrackerParams params_;
};

TEST_P(LineDetectorTest, BothEdgesOfAStripWithTheBrightSideAlongTheNormal) {
  const auto found = detect(testing::strips({{{-0.3, 0.02}, {0.3, 0.02}, 0.05}}));  // 180 px long, 30 px wide
  ASSERT_EQ(found.size(), 2U);
  for (const double y : {-9.0, 21.0}) {  // undistorted pixels: 300 a unit, from the optical axis
    const auto edge = std::find_if(found.begin(), found.end(), [&](const ImageLine& line) {
      return std::abs(line.start.y() - y) < 2 && std::abs(line.end.y() - y) < 2;
    });
    ASSERT_NE(edge, found.end()) << y;
    EXPECT_NEAR(edge->length(), 180, 15);
    EXPECT_EQ(edge->normal().y() > 0, y < 0);
  }
}

TEST_P(LineDetectorTest, PiecesOfOneEdgeAreJoined) {
  const auto gap = [](const Eigen::Vector2d& x) { return std::abs(x.x()) < 0.005; };  // of 3 px
  for (const ImageLine& line : detect(testing::strips({{{-0.3, 0.1}, {0.3, -0.1}, 0.05}}, gap)))
    EXPECT_GT(line.length(), 170);
}

TEST_P(LineDetectorTest, WhatIsShorterThanANewLineIsLeftOut) {
  params_.min_length_px = 50;
  EXPECT_TRUE(detect(testing::strips({{{0, 0}, {0.12, 0.02}, 0.06}})).empty());  // a square of 36 px
}

INSTANTIATE_TEST_SUITE_P(Detectors, LineDetectorTest, ::testing::Values("edge_drawing", "lsd"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace lintel
