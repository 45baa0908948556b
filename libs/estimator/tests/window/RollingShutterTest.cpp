// SPDX-License-Identifier: BSD-3-Clause
#include "window/RollingShutter.h"

#include <gtest/gtest.h>

#include <tuple>
#include <utility>

#include "TestWindow.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr double kLineDelay_s = 40e-6;  // 19 ms an image

/// One frame that turns and moves; what it sees is given as a rolling shutter shows it.
class RollingShutterTest : public testing::Test {
 protected:
  RollingShutterTest() : window_(test::windowAt({Pose{expRotation({0.1, -0.2, 0.05}), {0.3, 0.1, -0.2}}}, rig())) {
    WindowFrame& frame = window_.frames.front();
    const ImuBias bias{{0.01, -0.02, 0.03}, {0, 0, 0}};
    frame.motion << v_w_, bias.gyro, bias.accel;
    frame.gyro = omega_b_ + bias.gyro;
  }

  static Rig rig() {
    Rig rig = test::plainRig();
    rig.line_delay_s = kLineDelay_s;
    rig.T_b_c = {expRotation({0.02, 1.5, -0.3}), {0.05, -0.02, 0.1}};
    return rig;
  }

  Pose T_w_c(double dt_s) const {
    const Pose T_w_b = window_.frames.front().T_w_b();
    return Pose{T_w_b.q * expRotation(omega_b_ * dt_s), T_w_b.p + v_w_ * dt_s} * rig().T_b_c;
  }
  Eigen::Vector2d seenAt(const Eigen::Vector3d& p_w, double dt_s) const {
    return window_.camera().project(T_w_c(dt_s).inverse() * p_w);
  }
  /// The pixel whose row is exposed when the point is there.
  Eigen::Vector2d rolled(const Eigen::Vector3d& p_w) const {
    Eigen::Vector2d px = seenAt(p_w, 0);
    for (int i = 0; i < 20; ++i) px = seenAt(p_w, (px.y() - 239.5) * kLineDelay_s);
    return px;
  }
  /// The straight line that the front end fits to the bent edge.
  std::pair<Eigen::Vector2d, Eigen::Vector2d> rolled(const Segment3& segment_w) const {
    const Eigen::Vector2d first = rolled(segment_w.start), last = rolled(segment_w.end);
    const Eigen::Vector2d along = (last - first).normalized(), across(-along.y(), along.x());
    Eigen::Vector2d start = first, end = last;
    constexpr int kPieces = 200;
    for (int i = 0; i < kPieces; ++i) {  // least squares of a line by its ends, as EdgeFit has it
      const double share = (i + 0.5) / kPieces, x = 2 * share - 1;
      const double offset =
          across.dot(rolled(Eigen::Vector3d((1 - share) * segment_w.start + share * segment_w.end)) - first) / kPieces;
      start += (1 - 3 * x) * offset * across;
      end += (1 + 3 * x) * offset * across;
    }
    return {start, end};
  }
  Eigen::Vector3d inView(double x, double y, double depth_m) const { return T_w_c(0) * Eigen::Vector3d(x, y, depth_m); }

  const Eigen::Vector3d v_w_{0.8, -0.5, 0.3}, omega_b_{0.9, -1.1, 0.6};
  SlidingWindow window_;
};

TEST_F(RollingShutterTest, PointsComeToWhereTheMiddleRowsTimeHasThem) {
  TrackId id = 1;
  for (const double y : {-1.0, -0.3, 0.4, 1.0}) {
    const Eigen::Vector3d p_w = inView(0.6, y, 2.5);
    test::seePoint(window_, id, 0, p_w);
    PointTrack& track = window_.points[id++];
    track.sightings[0].seen_px = track.sightings[0].px = rolled(p_w);
    EXPECT_GT((rolled(p_w) - seenAt(p_w, 0)).norm(), 1) << y;
    track.point << p_w, 1;
    track.point.normalize();
    track.triangulated = true;
  }
  unroll(window_);
  for (id = 1; id <= 4; ++id) {
    const PointSighting& s = window_.points[id].sightings[0];
    const Eigen::Vector2d expected = seenAt(window_.positionOf(window_.points[id]), 0);
    EXPECT_LT((s.px - expected).norm(), 0.05) << id;  // the turn and the path are taken as straight
    EXPECT_LT((s.observation.ray - window_.camera().ray(s.px)).norm(), 1e-12);
  }
}

TEST_F(RollingShutterTest, WithoutDepthTheTurnIsTakenOut) {
  const Eigen::Vector3d far_w = inView(4000, -9000, 25000);
  test::seePoint(window_, 1, 0, far_w);
  window_.points[1].sightings[0].seen_px = rolled(far_w);
  unroll(window_);
  EXPECT_LT((window_.points[1].sightings[0].px - seenAt(far_w, 0)).norm(), 0.05);
}

TEST_F(RollingShutterTest, LinesComeToWhereTheMiddleRowsTimeHasThem) {
  const Segment3 segment_w{inView(-0.8, -0.9, 2.2), inView(0.5, 1.1, 3.0)};
  test::seeLine(window_, 1, 0, segment_w);
  LineTrack& track = window_.lines[1];
  LineSighting& s = track.sightings[0];
  std::tie(s.seen_start_px, s.seen_end_px) = rolled(segment_w);
  track.origin_w = segment_w.start + Eigen::Vector3d(0.1, -0.2, 0.3);
  track.line = toBlock(toOrthonormal(movedOrigin(lineThrough(segment_w.start, segment_w.end), track.origin_w)));
  track.triangulated = true;
  unroll(window_);
  const Eigen::Vector2d from = seenAt(segment_w.start, 0), along = (seenAt(segment_w.end, 0) - from).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  EXPECT_GT(std::abs(across.dot(s.seen_start_px - from)), 1);
  // the rows bend this edge, nearly as long as the image is high: its ends alone would come to lie 1.4 px beside it
  EXPECT_LT(std::abs(across.dot(s.start_px - from)), 0.25);
  EXPECT_LT(std::abs(across.dot(s.end_px - from)), 0.25);
  EXPECT_LT((s.end.ray - window_.camera().ray(s.end_px)).norm(), 1e-12);
}

TEST_F(RollingShutterTest, AGlobalShutterIsLeftAlone) {
  test::seePoint(window_, 1, 0, inView(0.5, 0.5, 2));
  const Eigen::Vector2d px = window_.points[1].sightings[0].px;
  window_.correction[kReadoutAt] = -window_.readout_s();  // the readout was given, and is found to be none
  unroll(window_);
  EXPECT_EQ(window_.points[1].sightings[0].px, px);
}

}  // namespace
}  // namespace lintel
