// SPDX-License-Identifier: BSD-3-Clause
#include "ImageLine.h"

#include <gtest/gtest.h>

#include <cmath>

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

Camera fisheye() {
  return {752, 480, 259.7, 259.4, 372.3, 243.1, {0.0034824, 0.000715, -0.0020532, 0.00020294}, LensModel::kEquidistant};
}

TEST(LineCamera, aWideLensIsSeenAlongTheAxisOfALine) {
  const LineCamera camera(fisheye());
  for (const Eigen::Vector2d& px : {Eigen::Vector2d(376, 240), Eigen::Vector2d(30, 240), Eigen::Vector2d(700, 30)}) {
    const ImageLine line = camera.lineFromImage(px, px + Eigen::Vector2d(20, 40));
    EXPECT_LT((line.start + line.end).norm(), 0.1 * line.length());  // about the axis
    EXPECT_NEAR(line.length(), 45, 20) << "of the image's size, also at the border";
    const Eigen::Vector2d u = line.at(0.3), h(1e-4, 0), v(0, 1e-4);
    const auto toImage = [&](const Eigen::Vector2d& at) { return camera.toImage(at, line.axis); };
    EXPECT_LT((camera.fromImage(toImage(u), line.axis) - u).norm(), 1e-7);
    const Eigen::Matrix2d J = camera.imageJacobian(u, line.axis);
    EXPECT_LT((J.col(0) - (toImage(u + h) - toImage(u - h)) / 2e-4).norm(), 1e-6);
    EXPECT_LT((J.col(1) - (toImage(u + v) - toImage(u - v)) / 2e-4).norm(), 1e-6);
    EXPECT_TRUE(camera.sees(u, 1, line.axis));
  }
}

TEST(LineCamera, aLineStaysTheSameSeenAlongAnotherAxis) {
  const LineCamera camera(fisheye());
  const ImageLine line = camera.lineFromImage({100, 100}, {130, 220}),
                  other = camera.seenFrom(camera.lineFromImage({120, 140}, {200, 240}).axis, line),
                  back = camera.seenFrom(line.axis, other);
  EXPECT_GT((other.axis - line.axis).norm(), 0.05);
  EXPECT_LT((camera.toImage(other.start, other.axis) - Eigen::Vector2d(100, 100)).norm(), 1e-7);
  EXPECT_LT((back.start - line.start).norm() + (back.end - line.end).norm(), 1e-7);
  const Eigen::Quaterniond R_c1_c0(Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.2, 0.9, 0.1).normalized()));
  const ImageLine turned = camera.turned(line, R_c1_c0);
  EXPECT_LT((camera.rayOf(turned.end, turned.axis) - R_c1_c0 * camera.rayOf(line.end, line.axis)).norm(), 1e-12);
}

TEST(LineCamera, clipsAtTheImageBorder) {
  const LineCamera camera(testing::testRig().camera);
  const auto clipped = camera.clip({{0, 0}, {2000, 0}}, 4);
  ASSERT_TRUE(clipped);
  EXPECT_EQ(clipped->start.norm(), 0);
  EXPECT_NEAR(camera.toImage(clipped->end).x(), 475, 0.5);
  EXPECT_FALSE(camera.clip({{0, -900}, {100, -900}}, 4));
}

TEST(LineCamera, givesLengthsOfTheReferenceCamera) {
  Camera pinhole = testing::testRig().camera;
  pinhole.fx = pinhole.fy = 916;
  EXPECT_EQ(LineCamera(pinhole).scaled(15), 30);
}

TEST(LineCamera, turnsALine) {
  const LineCamera camera(testing::testRig().camera);
  const Eigen::Quaterniond R_c1_c0(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  const ImageLine turned = camera.turned({{0, 0}, {0, 50}}, R_c1_c0);
  EXPECT_NEAR(turned.start.x(), camera.focal() * std::tan(0.1), 1e-9);
  EXPECT_NEAR(turned.start.y(), 0, 1e-12);
  EXPECT_NEAR(turned.end.y(), 50 / std::cos(0.1), 1e-9);
}

TEST(Relate, measuresAngleDistanceAndOverlap) {
  const LineRelation beside = relate({{0, 0}, {100, 0}}, {{50, 2}, {150, 4}});
  EXPECT_NEAR(beside.angle_rad, 0.02, 1e-4);
  EXPECT_NEAR(beside.distance_px, 4, 1e-12);
  EXPECT_NEAR(beside.overlap_px, 50, 1e-12);
  EXPECT_NEAR(relate({{0, 0}, {100, 0}}, {{110, 0}, {200, 0}}).overlap_px, -10, 1e-12);
  EXPECT_NEAR(relate({{0, 0}, {100, 0}}, {{100, 0}, {0, 0}}).angle_rad, M_PI, 1e-12);
}

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
