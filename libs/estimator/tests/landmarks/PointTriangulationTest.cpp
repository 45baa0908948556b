// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/PointTriangulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

const LandmarkParams kLandmarks;
const std::vector<Pose> kSideways{at(0, 0, 0), at(0.3, 0.02, 0), at(0.6, 0, 0.05), at(1, -0.1, 0)};
const Eigen::Vector3d kPoint(0.7, -0.4, 5);

/// Frames at kSideways that all see a point as track 1.
SlidingWindow windowThatSees(const Eigen::Vector3d& p_w) {
  SlidingWindow window = windowAt(kSideways);
  for (FrameId k = 0; k < 4; ++k) seePoint(window, 1, k, p_w);
  return window;
}

TEST(PointTriangulation, IsExactWithoutNoise) {
  SlidingWindow window = windowThatSees(kPoint);
  PointTrack& track = window.points[1];
  ASSERT_TRUE(triangulatePoint(window, kLandmarks, 1, track));
  EXPECT_TRUE(track.triangulated);
  EXPECT_LT((window.positionOf(track) - kPoint).norm(), 1e-9);
  EXPECT_NEAR(track.point.norm(), 1, 1e-12);
  EXPECT_NEAR(reprojectionError(window, track), 0, 1e-6);
}

TEST(PointTriangulation, SigmaIsThatOfBothRaysOfASingleBaseline) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0.5, 0, 0)});
  const Eigen::Vector3d p_w(0.2, 0.1, 4);
  for (FrameId k = 0; k < 2; ++k) seePoint(window, 1, k, p_w);
  ASSERT_TRUE(triangulatePoint(window, kLandmarks, 0.8, window.points[1]));
  // u1 - u0 = -f b lambda
  EXPECT_NEAR(window.points[1].sigma_inverse_depth, std::sqrt(2.0) * 0.8 / (500 * 0.5), 1e-9);
}

TEST(PointTriangulation, SigmaIsThatOfAStraightLineThroughTheSightings) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0.5, 0, 0), at(1, 0, 0), at(1.5, 0, 0)});
  for (FrameId k = 0; k < 4; ++k) seePoint(window, 1, k, {0.2, 0.1, 4});
  ASSERT_TRUE(triangulatePoint(window, kLandmarks, 0.8, window.points[1]));
  // u_k = u - f b_k lambda, u unknown: the squared distances of 0, 1, 2, 3 from their mean sum to 5
  EXPECT_NEAR(window.points[1].sigma_inverse_depth, 0.8 / (500 * 0.5 * std::sqrt(5.0)), 1e-9);
}

TEST(PointTriangulation, TheNoiseOfOneSightingIsNoParallaxHoweverManyFollowAtRest) {
  std::vector<Pose> poses{at(0, 0, 0)};
  for (int k = 0; k < 12; ++k) poses.push_back(at(0.005, 0, 0));  // so far a rest is not told from a motion
  SlidingWindow window = windowAt(poses);
  for (FrameId k = 0; k < poses.size(); ++k) seePoint(window, 1, k, {0.5, 0.2, 30}, {k == 0 ? 1.0 : 0, 0});
  EXPECT_FALSE(triangulatePoint(window, kLandmarks, 1, window.points[1]));
  EXPECT_FALSE(window.points[1].triangulated);
}

TEST(PointTriangulation, HandlesAFlight) {
  TrackSimulationParams tracks;
  tracks.duration_s = 3;
  const TrackedFlight flight = fly(perfectImu(), tracks);
  SlidingWindow window = trueWindow(flight, 0, 15);
  triangulatePoints(window, kLandmarks, 1);
  int triangulated = 0;
  for (const auto& [id, track] : window.points) {
    if (!track.triangulated) continue;
    ++triangulated;
    EXPECT_GE(static_cast<int>(track.sightings.size()), kLandmarks.point_min_observations);
    EXPECT_LT((window.positionOf(track) - flight.sim.points_w[flight.sim.point_of_track[id]]).norm(), 1e-4);
  }
  EXPECT_GT(triangulated, 100);
}

TEST(PointTriangulation, WithoutParallaxADepthIsNotGuessed) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0.001, 0, 0), at(0, 0.001, 0)});
  for (FrameId k = 0; k < 3; ++k) seePoint(window, 1, k, {0.5, 0.2, 30});
  EXPECT_FALSE(triangulatePoint(window, kLandmarks, 1, window.points[1]));
  EXPECT_FALSE(window.points[1].triangulated);
}

TEST(PointTriangulation, ContradictionsAndPointsBehindAreRefused) {
  SlidingWindow window = windowAt(kSideways);
  for (FrameId k = 0; k < 4; ++k) seePoint(window, 1, k, {0.7, -0.4, 5}, {0, k % 2 == 0 ? 12.0 : -12.0});
  EXPECT_FALSE(triangulatePoint(window, kLandmarks, 1, window.points[1]));
  // rays that diverge meet behind the cameras
  seePoint(window, 2, 0, {0, 0, 5});
  seePoint(window, 2, 3, {3, 0, 5});
  EXPECT_FALSE(triangulatePoint(window, kLandmarks, 1, window.points[2]));
  seePoint(window, 3, 0, {0, 0, 5});
  EXPECT_FALSE(triangulatePoint(window, kLandmarks, 1, window.points[3])) << "one sighting";
}

TEST(ReprojectionError, IsTheMeanDistanceInPixels) {
  SlidingWindow window = windowThatSees(kPoint);
  PointTrack& track = window.points[1];
  ASSERT_TRUE(triangulatePoint(window, kLandmarks, 1, track));
  track.sightings[2].px += Eigen::Vector2d(3, 4);
  EXPECT_NEAR(reprojectionError(window, track), 5.0 / 4, 1e-6);
  window.frames[1].pose = toBlock(at(0, 0, 20));  // past the point
  EXPECT_EQ(reprojectionError(window, track), std::numeric_limits<double>::infinity());
}

TEST(PointUncertainty, OnlyEverImproves) {
  SlidingWindow window = windowAt(kSideways);
  for (FrameId k = 0; k < 3; ++k) seePoint(window, 1, k, {0.7, -0.4, 5});
  PointTrack& track = window.points[1];
  ASSERT_TRUE(triangulatePoint(window, kLandmarks, 1, track));
  const double three = track.sigma_inverse_depth;
  seePoint(window, 1, 3, {0.7, -0.4, 5});
  updatePointUncertainty(window, 1, track);
  const double four = track.sigma_inverse_depth;
  EXPECT_LT(four, 0.8 * three);
  track.sightings.erase(track.sightings.begin() + 2, track.sightings.end());
  updatePointUncertainty(window, 1, track);
  EXPECT_EQ(track.sigma_inverse_depth, four);
}

}  // namespace
}  // namespace lintel
