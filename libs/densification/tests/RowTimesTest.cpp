// SPDX-License-Identifier: BSD-3-Clause
#include "RowTimes.h"

#include <gtest/gtest.h>

#include "TestFlight.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// Keyframes that turn and move steadily; everything seen is 5 m away.
class RowTimesTest : public testing::Test {
 protected:
  RowTimesTest() {
    MapMaterial& m = flight_.material;
    m.rig.T_b_c = {expRotation({0.1, -0.2, 0.3}), {0.03, 0.02, -0.01}};
    for (RetiredKeyframe& k : m.keyframes) {
      k.T_w_b = poseAt(1e-9 * static_cast<double>(k.t_ns));
      k.v_w_b = v_w_;
      m.trajectory.emplace_back(k.t_ns, k.T_w_b);
    }
    m.points.clear();
    for (const RetiredKeyframe& k : m.keyframes) {
      PointRecord point;
      point.known = true;
      point.p_w = at(k, {200, 300});
      point.views = {{static_cast<std::uint32_t>(k.id), {200, 300}, true}};
      m.points.push_back(point);
    }
  }

  Pose poseAt(double t_s) const { return {expRotation(omega_b_ * t_s), v_w_ * t_s}; }

  /// What is 5 m away on the ray of a pixel.
  Eigen::Vector3d at(const RetiredKeyframe& k, const Eigen::Vector2d& px) const {
    return (k.T_w_b * flight_.material.rig.T_b_c) * (5 * flight_.material.rig.camera.ray(px).normalized());
  }

  /// Where the shutter's row sees a point that the camera has at `px` at the frame's time.
  Eigen::Vector2d seenByRow(const RetiredKeyframe& k, const Eigen::Vector2d& px) const {
    const Rig& rig = flight_.material.rig;
    Eigen::Vector2d seen = px;
    for (int i = 0; i < 5; ++i) {
      const double dt_s = rig.readout_s() * (seen.y() - 0.5 * (rig.camera.height - 1)) / rig.camera.height;
      const Pose T_w_c = poseAt(1e-9 * static_cast<double>(k.t_ns) + dt_s) * rig.T_b_c;
      seen = rig.camera.project(T_w_c.inverse() * at(k, px));
    }
    return seen;
  }

  test::TestFlight flight_;
  const Eigen::Vector3d omega_b_{0.4, -0.3, 0.2}, v_w_{0.3, 0.1, -0.2};
};

TEST_F(RowTimesTest, EdgesOfARollingShutterAreMovedToTheFramesTime) {
  flight_.material.rig.line_delay_s = 0.02 / 480;
  const RowTimes rows(flight_.material);
  const RetiredKeyframe& k = flight_.material.keyframes[4];
  const Eigen::Vector2f start(100, 140), end(160, 330);  // short: the rows bend it by 0.04 px
  std::vector<EdgeSegment> edges{
      {seenByRow(k, start.cast<double>()).cast<float>(), seenByRow(k, end.cast<double>()).cast<float>(), 0.3f}};
  ASSERT_GT((edges[0].start_px - start).norm(), 1);
  rows.move(4, edges);
  EXPECT_LT((edges[0].start_px - start).norm(), 0.1);
  EXPECT_LT((edges[0].end_px - end).norm(), 0.1);
}

TEST_F(RowTimesTest, EdgesOfAGlobalShutterStay) {
  const RowTimes rows(flight_.material);
  std::vector<EdgeSegment> edges{{{100, 40}, {600, 430}, 0.3f}};
  rows.move(4, edges);
  EXPECT_EQ(edges[0].start_px, Eigen::Vector2f(100, 40));
  EXPECT_EQ(edges[0].end_px, Eigen::Vector2f(600, 430));
}

}  // namespace
}  // namespace lintel
