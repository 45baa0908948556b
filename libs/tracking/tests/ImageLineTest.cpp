// SPDX-License-Identifier: BSD-3-Clause
#include "ImageLine.h"

#include <gtest/gtest.h>

#include "TestImages.h"

namespace lintel {
namespace {

TEST(LineCamera, goesThroughTheLensAndBack) {
  const LineCamera camera(testing::testRig().camera);
  const Eigen::Vector2d u = camera.fromImage({70, 250}), h(1e-4, 0), v(0, 1e-4);
  EXPECT_LT((camera.toImage(u) - Eigen::Vector2d(70, 250)).norm(), 1e-8);
  const Eigen::Matrix2d J = camera.imageJacobian(u);
  EXPECT_LT((J.col(0) - (camera.toImage(u + h) - camera.toImage(u - h)) / 2e-4).norm(), 1e-6);
  EXPECT_LT((J.col(1) - (camera.toImage(u + v) - camera.toImage(u - v)) / 2e-4).norm(), 1e-6);
}

TEST(LineCamera, clipsAtTheImageBorder) {
  const LineCamera camera(testing::testRig().camera);
  const auto clipped = camera.clip({{0, 0}, {2000, 0}}, 4);
  ASSERT_TRUE(clipped);
  EXPECT_EQ(clipped->start.norm(), 0);
  EXPECT_NEAR(camera.toImage(clipped->end).x(), 475, 0.5);
  EXPECT_FALSE(camera.clip({{0, -900}, {100, -900}}, 4));
}

TEST(Relate, measuresAngleDistanceAndOverlap) {
  const LineRelation beside = relate({{0, 0}, {100, 0}}, {{50, 2}, {150, 4}});
  EXPECT_NEAR(beside.angle_rad, 0.02, 1e-4);
  EXPECT_NEAR(beside.distance_px, 4, 1e-12);
  EXPECT_NEAR(beside.overlap_px, 50, 1e-12);
  EXPECT_NEAR(relate({{0, 0}, {100, 0}}, {{110, 0}, {200, 0}}).overlap_px, -10, 1e-12);
  EXPECT_NEAR(relate({{0, 0}, {100, 0}}, {{100, 0}, {0, 0}}).angle_rad, M_PI, 1e-12);
}

}  // namespace
}  // namespace lintel
