// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/RowMotion.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// A body that moves with constant acceleration in its own axes, and what a camera on it sees.
class RowMotionTest : public testing::Test {
 protected:
  Pose T_w_c(double t_s) const {
    const Eigen::Vector3d turn = motion_.omega_b * t_s + change_.angular_acceleration_b * (0.5 * t_s * t_s);
    const Eigen::Vector3d path = motion_.v_b * t_s + change_.acceleration_b * (0.5 * t_s * t_s);
    return Pose{T_w_b_.q * expRotation(turn), T_w_b_.p + T_w_b_.q * path} * T_b_c_;
  }
  /// How far from the truth what is seen at `dt_s` comes to lie at the frame's time [rad].
  double error(const Eigen::Vector3d& p_c, double dt_s, const MotionChange& change) const {
    const Eigen::Vector3d p_w = T_w_c(0) * p_c, seen_c = T_w_c(dt_s).inverse() * p_w;
    const RowMotion rows(T_b_c_, motion_, change);
    const Eigen::Vector3d ray = rows.rayAtFrameTime(seen_c.normalized(), dt_s, 1 / seen_c.norm());
    return ray.normalized().cross(p_c.normalized()).norm();
  }

  const Pose T_w_b_{expRotation({0.3, -0.2, 0.9}), {1, 2, 3}}, T_b_c_{expRotation({0.1, 1.2, -0.4}), {0.2, -0.1, 0.3}};
  const FrameMotion motion_{{1.2, -0.6, 0.4}, {0.8, -1.5, 0.6}};
  const MotionChange change_{{3, -2, 4}, {8, 5, -6}};
};

TEST_F(RowMotionTest, TakesTheAccelerationsIntoAccount) {
  for (const double dt_s : {-0.01, 0.01}) {
    const double with = error({0.5, -0.4, 2}, dt_s, change_), without = error({0.5, -0.4, 2}, dt_s, {});
    EXPECT_LT(with, 2e-5) << dt_s;  // 0.01 px: what is left is of the third order
    EXPECT_GT(without, 2e-4) << dt_s;
  }
}

TEST_F(RowMotionTest, WhatIsLeftIsOfTheThirdOrder) {
  EXPECT_NEAR(error({0.5, -0.4, 2}, 0.02, change_) / error({0.5, -0.4, 2}, 0.01, change_), 8, 1);
}

TEST(RowShare, FromTheFirstRowToTheLast) {
  Camera camera;
  camera.width = 640, camera.height = 480;
  EXPECT_DOUBLE_EQ(rowShare(camera, {10, 239.5}), 0);
  EXPECT_NEAR(rowShare(camera, {10, -0.5}), -0.5, 1e-12);
  EXPECT_NEAR(rowShare(camera, {600, 479.5}), 0.5, 1e-12);
}

/// A camera whose rows have moved a straight edge by a shear and a bend, in undistorted pixels.
class LineAtFrameTimeTest : public testing::Test {
 protected:
  LineAtFrameTimeTest() {
    camera_.width = 752, camera_.height = 480;
    camera_.fx = camera_.fy = 460, camera_.cx = 376, camera_.cy = 240;
  }
  Eigen::Vector3d moved(const Eigen::Vector2d& px, double shear, double bend) const {
    const double y = (px.y() - 240) / 100;
    return camera_.ray(px + Eigen::Vector2d(shear * y + bend * y * y, 0));
  }

  Camera camera_;
};

TEST_F(LineAtFrameTimeTest, AStraightEdgeKeepsItsEnds) {
  const Eigen::Vector2d start(300, 140), end(330, 340);
  const auto [a, b] =
      lineAtFrameTime(camera_, camera_, start, end, [&](const Eigen::Vector2d& px) { return moved(px, 3, 0); });
  EXPECT_LT((a - start - Eigen::Vector2d(-3, 0)).norm(), 0.005);  // offsets are of another plane than the image
  EXPECT_LT((b - end - Eigen::Vector2d(3, 0)).norm(), 0.005);
}

TEST_F(LineAtFrameTimeTest, ABentEdgeIsFittedAsAWhole) {
  // x = 2 y^2 over y in [-1, 1]: the line that fits best is x = 2/3, the ends alone would say 2
  const auto [a, b] = lineAtFrameTime(camera_, camera_, {376, 140}, {376, 340},
                                      [&](const Eigen::Vector2d& px) { return moved(px, 0, 2); });
  EXPECT_LT((a - Eigen::Vector2d(376 + 2.0 / 3, 140)).norm(), 1e-9);
  EXPECT_LT((b - Eigen::Vector2d(376 + 2.0 / 3, 340)).norm(), 1e-9);
}

}  // namespace
}  // namespace lintel
