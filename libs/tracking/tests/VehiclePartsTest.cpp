// SPDX-License-Identifier: BSD-3-Clause
#include "VehicleParts.h"

#include <gtest/gtest.h>

#include "LineSteps.h"
#include "TestImages.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/tracking/FrontEnd.h"

namespace lintel {
namespace {

using testing::kStep_ns;

/// Points of the scene on a grid, that move by what rotation says.
std::vector<FollowedPoint> sceneThatTurns(const cv::Point2f& turn) {
  std::vector<FollowedPoint> points;
  for (int i = 0; i < 12; ++i) {
    const cv::Point2f from(40.0f + 100.0f * static_cast<float>(i % 4), 30.0f + 60.0f * static_cast<float>(i / 4));
    points.push_back({from, from + turn + cv::Point2f(0.3f, -0.2f), from + turn});
  }
  return points;
}

FollowedPoint staying(const cv::Point2f& px, const cv::Point2f& turn) {
  return {px, px + cv::Point2f(0.1f, 0.1f), px + turn};
}

bool covers(const VehicleParts& parts, int x, int y) {
  return !parts.area().empty() && parts.area().at<unsigned char>(y, x) != 0;
}

constexpr int kHoodX = 200, kHoodY = 290;
const cv::Point2f kHood(kHoodX, kHoodY);

class VehiclePartsTest : public ::testing::Test {
 protected:
  /// Steps in which a point of the hood stays while the scene turns.
  bool turn(const cv::Point2f& by, int steps, const std::vector<cv::Point2f>& hood = {kHood}) {
    bool found = false;
    for (int i = 0; i < steps; ++i) {
      std::vector<FollowedPoint> points = sceneThatTurns(by);
      for (const cv::Point2f& px : hood) points.push_back(staying(px, by));
      found = parts_.observe(points) || found;
    }
    return found;
  }

  VehicleParts parts_{testing::testRig().camera};
};

TEST_F(VehiclePartsTest, WhatStaysWhileTheCameraTurnsToAndFroIsAPart) {
  EXPECT_EQ(parts_.share(), 0);
  EXPECT_FALSE(turn({5, 1}, 4));
  EXPECT_TRUE(turn({-5, 1}, 4));
  EXPECT_TRUE(covers(parts_, kHoodX, kHoodY));
  EXPECT_FALSE(covers(parts_, kHoodX, kHoodY - 60));
  EXPECT_FALSE(covers(parts_, 40, 30));
  EXPECT_GT(parts_.share(), 0.001);
  EXPECT_LT(parts_.share(), 0.05);
}

TEST_F(VehiclePartsTest, InOneDirectionTranslationMayCompensateForTheTurn) { EXPECT_FALSE(turn({5, 1}, 100)); }

TEST_F(VehiclePartsTest, SlowTurnsSayNothing) {
  EXPECT_FALSE(turn({1.5, 0}, 50));
  EXPECT_FALSE(turn({-1.5, 0}, 50));
}

TEST_F(VehiclePartsTest, ATurnOutOfViewSaysNothing) {
  turn({5, 1}, 4);
  for (int i = 0; i < 4; ++i) {
    std::vector<FollowedPoint> points = sceneThatTurns({-5, 1});
    points.push_back({kHood, kHood, {-1e4f, -1e4f}});
    EXPECT_FALSE(parts_.observe(points));
  }
}

TEST_F(VehiclePartsTest, WhereNothingMovesTheGyroscopeIsWrong) {
  for (int i = 0; i < 40; ++i) {
    const cv::Point2f turn(i % 8 < 4 ? 5 : -5, 0);
    std::vector<FollowedPoint> points = sceneThatTurns(turn);
    for (FollowedPoint& p : points) p.to = p.from;
    EXPECT_FALSE(parts_.observe(points));
  }
}

TEST_F(VehiclePartsTest, WherePointsOfTheScenePassIsNoPart) {
  for (int i = 0; i < 40; ++i) {
    const cv::Point2f turn(i % 8 < 4 ? 5 : -5, 0);
    std::vector<FollowedPoint> points = sceneThatTurns(turn);
    points.push_back(staying(kHood, turn));
    if (i % 4 == 0) points.push_back({kHood, kHood + turn, kHood + turn});
    EXPECT_FALSE(parts_.observe(points)) << i;
  }
}

TEST_F(VehiclePartsTest, NearAPartLessIsEnough) {
  const cv::Point2f beside(kHood.x + 50, kHood.y), far(kHood.x + 180, kHood.y);
  turn({5, 1}, 4);
  turn({-5, 1}, 4);
  EXPECT_FALSE(covers(parts_, 250, kHoodY));
  EXPECT_TRUE(turn({5, 1}, 2, {beside, far}));
  EXPECT_TRUE(covers(parts_, 250, kHoodY));
  EXPECT_TRUE(covers(parts_, 225, kHoodY));  // between both
  EXPECT_FALSE(covers(parts_, 380, kHoodY));
}

/// Steps of lines that are detected in two images between which the camera turned.
std::vector<FollowedPoint> stepsOf(const ImageLine& before, const ImageLine& now, const Eigen::Quaterniond& R_c1_c0) {
  const LineCamera camera(testing::testRig().camera);
  LineSteps steps(camera);
  steps.turn(R_c1_c0);
  EXPECT_TRUE(steps.followed({before}).empty());  // there is none before the first
  steps.turn(R_c1_c0);
  return steps.followed({now});
}

TEST(LineSteps, ALineStaysOrMovesAsTheCameraTurns) {
  const LineCamera camera(testing::testRig().camera);
  const ImageLine line = camera.lineFromImage({150, 200}, {250, 210});
  const Eigen::Quaterniond pitch = expRotation({0.04, 0, 0});  // 12 px
  const auto stay = stepsOf(line, line, pitch);
  ASSERT_GT(stay.size(), 4U);
  for (const FollowedPoint& p : stay) {
    EXPECT_EQ(p.to, p.from);
    EXPECT_NEAR(cv::norm(p.turned - p.from), 12, 1.5);
  }
  const auto moved = stepsOf(line, camera.turned(line, pitch), pitch);
  ASSERT_EQ(moved.size(), stay.size());
  for (const FollowedPoint& p : moved) EXPECT_EQ(p.to, p.turned);
}

TEST(LineSteps, WhatIsInNeitherPlaceOrDoesNotMoveAcrossSaysNothing) {
  const LineCamera camera(testing::testRig().camera);
  const ImageLine line = camera.lineFromImage({150, 160}, {250, 160}),
                  other = camera.lineFromImage({150, 80}, {250, 80});
  EXPECT_TRUE(stepsOf(line, other, expRotation({0.04, 0, 0})).empty());
  EXPECT_TRUE(stepsOf(line, line, expRotation({0, 0.04, 0})).empty());  // along itself
}

/// The frames of a camera that turns to and fro, with a textured hood over the lower quarter.
std::vector<Frame> framesWithHood(const Rig& rig, const std::vector<double>& angles, const cv::Rect& hood) {
  const Frame paint = testing::renderScene(rig, testing::blobs(8), 0);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    Frame frame = testing::renderScene(rig, testing::blobs(3), static_cast<std::int64_t>(i) * kStep_ns,
                                       expRotation({-angles[i], 0.7 * angles[i], 0}));
    auto image = std::make_shared<GrayImage>(*frame.image);
    for (int y = hood.y; y < hood.br().y; ++y)
      for (int x = hood.x; x < hood.br().x; ++x) {
        const auto at = static_cast<std::size_t>(y * image->width + x);
        image->pixels[at] = paint.image->pixels[at];
      }
    frame.image = image;
    frames.push_back(frame);
  }
  return frames;
}

TEST(FrontEnd, leavesOutAHoodWhenTheCameraHasTurnedToAndFro) {
  const Rig rig = testing::testRig();
  const cv::Rect hood(0, 240, 480, 80);
  constexpr double kRate = 0.4;  // [rad/s]
  std::vector<double> angles{0};
  for (int i = 0; i < 24; ++i) angles.push_back(angles.back() + (i % 8 < 4 ? 1 : -1) * kRate * 0.05);
  const std::vector<Frame> frames = framesWithHood(rig, angles, hood);
  FrontEnd front_end(rig, FrontEndParams{});
  std::vector<FrameTracks> tracks;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double rate = i == 0 ? 0 : (angles[i] - angles[i - 1]) / 0.05;
    const auto t_ns = frames[i].t_ns;
    tracks.push_back(front_end.process(
        frames[i],
        i == 0 ? ImuBatch{}
               : testing::constantRate(t_ns - kStep_ns, t_ns, rig.T_b_c.q * Eigen::Vector3d(rate, -0.7 * rate, 0))));
  }
  const auto onHood = [&](const FrameTracks& frame) {
    return std::count_if(frame.points.begin(), frame.points.end(), [&](const PointObservation& p) {
      return hood.contains({static_cast<int>(p.px.x()), static_cast<int>(p.px.y())});
    });
  };
  EXPECT_GT(onHood(tracks.front()), 15);
  EXPECT_LE(onHood(tracks.back()), 3);
  EXPECT_GT(tracks.back().points.size(), 50U);
  EXPECT_NEAR(front_end.statistics().vehicle_share, 0.25, 0.08);
  front_end.leaveOutVehicle(tracks.front());
  EXPECT_LE(onHood(tracks.front()), 3);
  EXPECT_GT(tracks.front().points.size(), 50U);
}

}  // namespace
}  // namespace lintel
