// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeRefiner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ImagePyramid.h"
#include "TestImages.h"

namespace lintel {
namespace {

using testing::Strip;

/// A wide strip from (-0.5, y) to (0.5, y): its upper edge is the line under test.
class EdgeRefinerTest : public ::testing::Test {
 protected:
  EdgeRefinerTest() : camera_(rig_.camera), refiner_(camera_), pyramid_({}, 13) {}

  void show(const testing::Scene& scene) { pyramid_.push(*testing::renderScene(rig_, scene, 0).image); }

  ImageLine line(double x0, double y0, double x1, double y1) const {
    return {camera_.focal() * Eigen::Vector2d(x0, y0), camera_.focal() * Eigen::Vector2d(x1, y1)};
  }

  const Rig rig_ = testing::testRig();
  LineCamera camera_;
  EdgeRefiner refiner_;
  ImagePyramid pyramid_;
  // Tilted a little, so that the edge crosses pixels everywhere; its upper edge is 0.05 above the middle.
  const Strip strip_{{-0.5, -0.22}, {0.5, -0.18}, 0.05};
};

TEST_F(EdgeRefinerTest, laysALineOnTheEdgeThroughTheLens) {
  show(testing::strips({strip_}));
  const double focal = camera_.focal();
  const Eigen::Vector2d d = (strip_.end - strip_.start).normalized(), up(d.y(), -d.x());
  const Eigen::Vector2d on_edge = strip_.start + strip_.half_width * up;
  ImageLine guess{focal * (on_edge + 0.1 * d), focal * (on_edge + 0.9 * d)};
  guess.start.y() += 2.0;  // px
  guess.end.y() -= 1.0;
  const auto refined = refiner_.refine(pyramid_, guess, 3, 0);
  ASSERT_TRUE(refined);
  for (const Eigen::Vector2d& end : {refined->line.start, refined->line.end})
    EXPECT_LT(std::abs(up.dot(end - focal * on_edge)), 0.15);
  EXPECT_GT(refined->support, 0.95);
  EXPECT_LT(refined->sigma_px, 0.5);
}

TEST_F(EdgeRefinerTest, doesNotTakeTheEdgeOfOppositeContrast) {
  show(testing::strips({strip_}));
  // Reversed: the bright side would have to be above the upper edge.
  EXPECT_FALSE(refiner_.refine(pyramid_, line(0.4, -0.234, -0.4, -0.266), 3, 0));
}

TEST_F(EdgeRefinerTest, trimsWhatHasNoEdgeAndGrowsAlongTheEdge) {
  show(testing::strips({strip_}));
  const auto trimmed = refiner_.refine(pyramid_, line(-0.66, -0.2764, 0.2, -0.242), 3, 0);
  ASSERT_TRUE(trimmed);
  EXPECT_NEAR(trimmed->line.start.x() / camera_.focal(), -0.5, 0.03);
  const auto grown = refiner_.refine(pyramid_, line(-0.2, -0.258, 0.2, -0.242), 3, 24);
  ASSERT_TRUE(grown);
  EXPECT_NEAR(grown->line.length() - 0.4 * camera_.focal(), 48, 8);
}

TEST_F(EdgeRefinerTest, anEdgeThatMeetsAtAnAcuteAngleDoesNotTurnTheLine) {
  // The strip's upper edge ends at x = 0, where one goes on that bends away by 6 degrees.
  const double bend = std::tan(0.105);
  show([&](const Eigen::Vector2d& x) {
    const double edge = -0.25 + (x.x() > 0 ? bend * x.x() : 0.0);
    return x.y() > edge && x.y() < 0.3 ? 180.0 : 60.0;
  });
  const auto refined = refiner_.refine(pyramid_, line(-0.16, -0.25, -0.02, -0.25), 3, 40);
  ASSERT_TRUE(refined);
  EXPECT_LT(refined->line.end.x() / camera_.focal(), 0.06);
  for (const Eigen::Vector2d& end : {refined->line.start, refined->line.end})
    EXPECT_LT(std::abs(end.y() + 0.25 * camera_.focal()), 1.0);
}

TEST_F(EdgeRefinerTest, findsABlurredEdgeAtHalfResolution) {
  // A faint ramp 12 px wide: at full resolution nowhere steeper than the 2 grey levels a pixel that an edge needs.
  const double focal = camera_.focal();
  show([&](const Eigen::Vector2d& x) {
    const double t = std::clamp((x.y() + 0.15) * focal / 12, 0.0, 1.0);
    return 80 + 14 * t * t * (3 - 2 * t);
  });
  const auto refined = refiner_.refine(pyramid_, line(-0.4, -0.125, 0.4, -0.125), 3, 0);
  ASSERT_TRUE(refined);
  EXPECT_NEAR(0.5 * (refined->line.start.y() + refined->line.end.y()), focal * -0.15 + 6, 1.0);
  EXPECT_GT(refined->sigma_px, 0.45);  // larger, as the edge is blurred
}

TEST_F(EdgeRefinerTest, findsNothingOnAPlainImage) {
  show([](const Eigen::Vector2d&) { return 100.0; });
  EXPECT_FALSE(refiner_.refine(pyramid_, line(-0.3, 0, 0.3, 0), 3, 0));
}

TEST_F(EdgeRefinerTest, turnsTheNormalToTheBrighterSide) {
  show(testing::strips({strip_}));
  for (const bool reversed : {false, true}) {
    const ImageLine given = reversed ? line(0.4, -0.234, -0.4, -0.266) : line(-0.4, -0.266, 0.4, -0.234);
    const auto oriented = refiner_.orient(pyramid_.image(), given);
    ASSERT_TRUE(oriented);
    EXPECT_GT(oriented->normal().y(), 0.9);  // the strip lies below its upper edge
  }
}

}  // namespace
}  // namespace lintel
