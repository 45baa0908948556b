// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowMarginalization.h"

#include <gtest/gtest.h>

#include <cmath>

#include <algorithm>

#include "DenseReference.h"
#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "solver/Marginalizer.h"
#include "window/LastingPoints.h"
#include "window/OutlierRejection.h"
#include "window/WindowFactors.h"

namespace lintel {
namespace {

using namespace test;

bool touches(const WindowPrior& prior, BlockKey::Kind kind, std::uint64_t id) {
  return std::find(prior.blocks.begin(), prior.blocks.end(), BlockKey{kind, id}) != prior.blocks.end();
}

WindowPrior motionPrior(const SlidingWindow& window, FrameId id) {
  WindowPrior prior;
  prior.blocks = {{BlockKey::kMotion, id}};
  prior.factor = makeBlockPrior(manifoldOf(BlockKey::kMotion), window.frame(id).motion,
                                Eigen::VectorXd::Constant(kMotionSize, 0.1));
  return prior;
}

/// Every track starts anew when its oldest frame leaves.
const EstimatorParams kNoneLasts = [] {
  EstimatorParams params;
  params.landmarks.lasting_points = 0;
  return params;
}();

SlidingWindow flownWindow() {
  TrackSimulationParams tracks;
  tracks.duration_s = 2;
  tracks.max_points_per_frame = 40;
  SlidingWindow window = trueWindow(fly(perfectImu(), tracks), 0, 8);
  triangulatePoints(window, kParams.landmarks, 1);
  triangulateLines(window, kParams);
  return window;
}

TEST(MarginaliseOldest, LeavesOnePriorOnTheStatesThatStay) {
  SlidingWindow window = flownWindow();
  window.priors = {motionPrior(window, 0), motionPrior(window, 5)};
  const auto untouched = window.priors[1].factor;
  marginaliseOldest(window, kNoneLasts);
  ASSERT_EQ(window.priors.size(), 2u);
  EXPECT_EQ(window.priors[0].factor, untouched) << "a prior on other frames stays as it is";
  const WindowPrior& prior = window.priors[1];
  EXPECT_FALSE(touches(prior, BlockKey::kPose, 0));
  EXPECT_FALSE(touches(prior, BlockKey::kMotion, 0));
  EXPECT_TRUE(touches(prior, BlockKey::kPose, 1));
  EXPECT_TRUE(touches(prior, BlockKey::kMotion, 1)) << "by the IMU";
  EXPECT_TRUE(touches(prior, BlockKey::kPose, 6)) << "by points seen from 0 to 6";
  EXPECT_FALSE(touches(prior, BlockKey::kPose, 7)) << "what the newest frame sees is still to come";
  EXPECT_TRUE(touches(prior, BlockKey::kExtrinsics, 0));
  for (const BlockKey& key : prior.blocks) EXPECT_TRUE(key.kind != BlockKey::kPoint && key.kind != BlockKey::kLine);
  EXPECT_TRUE(window.contains(0)) << "removing the frame is the caller's";
}

/// Only those measurements are made that may become part of the prior.
TEST(MarginaliseOldest, ThePriorIsThatOfAllMeasurements) {
  SlidingWindow window = flownWindow();
  marginaliseOldest(window, kParams);  // its prior knows points, which the next oldest frame need not see
  window.removeFrame(0, true);
  ASSERT_FALSE(pointsInPriors(window).empty());
  PointTrack& unseen = window.points.at(pointsInPriors(window).begin()->id);
  unseen.sightings.erase(unseen.sightings.begin());
  SlidingWindow other = window;
  WindowFactors all(other, kParams.factors);
  all.addMeasurements(kParams);
  marginaliseOldest(other, all.factors(), kParams.landmarks, 0);
  marginaliseOldest(window, kParams);
  ASSERT_EQ(window.priors.back().blocks, other.priors.back().blocks);
  EXPECT_EQ(window.priors.back().factor->root(), other.priors.back().factor->root());
  EXPECT_EQ(window.priors.back().factor->constant(), other.priors.back().factor->constant());
}

TEST(MarginaliseOldest, NoSightingCountsTwice) {
  SlidingWindow window = flownWindow();
  // some tracks were lost before the newest frame
  for (TrackId id : {1u, 2u, 3u, 4u, 5u, 6u})
    if (auto it = window.points.find(id); it != window.points.end() && it->second.sightings.size() > 4)
      it->second.sightings.resize(4);
  const SlidingWindow before = window;
  marginaliseOldest(window, kNoneLasts);
  int consumed = 0, untouched = 0, lost = 0;
  for (const auto& [id, track] : window.points) {
    const PointTrack& was = before.points.at(id);
    const bool used = was.triangulated && was.sightings.size() > 1 && was.sightings.front().frame == 0;
    if (!used) {
      EXPECT_EQ(track.sightings.size(), was.sightings.size());
      ++untouched;
    } else if (was.sightings.back().frame == 7 && was.sightings.size() > 2) {
      ASSERT_EQ(track.sightings.size(), 2u);
      EXPECT_EQ(track.sightings.front().frame, 0u);
      EXPECT_EQ(track.sightings.back().frame, 7u);
      EXPECT_EQ(track.former.size(), was.sightings.size() - 2) << "they stay part of the track's history";
      ++consumed;
    } else if (was.sightings.back().frame != 7) {
      ASSERT_EQ(track.sightings.size(), 1u) << "the oldest frame's, which goes with it";
      EXPECT_EQ(track.former.size(), was.sightings.size() - 1);
      ++lost;
    }
  }
  EXPECT_GT(lost, 1);
  EXPECT_GT(consumed, 5);
  EXPECT_GT(untouched, 5);
}

TEST(MarginaliseOldest, LastingPointsStayInThePriorWithTheSightingsToCome) {
  SlidingWindow window = flownWindow();
  EstimatorParams params;
  params.landmarks.lasting_points = 5;
  const SlidingWindow before = window;
  marginaliseOldest(window, params);
  const std::set<BlockKey> lasting = pointsInPriors(window);
  ASSERT_EQ(lasting.size(), 5u);
  for (const BlockKey& key : lasting) {
    const PointTrack &track = window.points.at(key.id), &was = before.points.at(key.id);
    EXPECT_EQ(was.sightings.front().frame, 0u) << "the oldest frame saw it";
    EXPECT_EQ(track.sightings.size(), was.sightings.size()) << "only the oldest one is used, and leaves with its frame";
    EXPECT_TRUE(touches(window.priors.back(), BlockKey::kPoint, key.id));
  }
  // the next prior holds those that are still seen, and the one that was lost leaves with all its sightings
  window.removeFrame(0, true);
  PointTrack& lost = window.points.at(lasting.begin()->id);
  while (lost.sightings.back().frame > 4) lost.sightings.pop_back();
  params.landmarks.lasting_points = 0;  // no new ones
  marginaliseOldest(window, params);
  EXPECT_EQ(pointsInPriors(window).size(), 4u);
  EXPECT_EQ(pointsInPriors(window).count({BlockKey::kPoint, lost.id}), 0u);
  EXPECT_EQ(lost.sightings.size(), 1u);
}

TEST(MarginaliseOldest, PointsThatFitBadlyDoNotLast) {
  SlidingWindow window = flownWindow();
  marginaliseOldest(window, kParams);
  const BlockKey bad = *pointsInPriors(window).begin();
  window.removeFrame(0, true);
  for (PointSighting& s : window.points.at(bad.id).sightings) s.px += Eigen::Vector2d(8, 0);
  EXPECT_EQ(rejectOutliers(window, kParams.landmarks), 0) << "a prior holds it until the next one is made";
  marginaliseOldest(window, kParams);
  EXPECT_EQ(pointsInPriors(window).count(bad), 0u);
}

TEST(MarginaliseSecondNewest, ALastingPointThatItTookAlongLeavesThePrior) {
  SlidingWindow window = flownWindow();
  marginaliseOldest(window, kParams);
  window.removeFrame(0, true);
  const BlockKey key = *pointsInPriors(window).begin();
  PointTrack& track = window.points.at(key.id);
  track.sightings = {track.sightings[track.sightings.size() - 2]};
  ASSERT_EQ(track.sightings.back().frame, 6u);
  marginaliseSecondNewest(window);
  EXPECT_EQ(pointsInPriors(window).count(key), 0u);
  EXPECT_GE(pointsInPriors(window).size(), 3u);
}

TEST(MarginaliseOldest, TheNewestFramesSightingsStayOutOfThePrior) {
  // Wherever the newest frame is said to have seen the points: the prior is the same, and those sightings are still
  // there for what comes.
  SlidingWindow window = flownWindow(), other = window;
  for (auto& [id, track] : other.points)
    if (track.sightings.back().frame == 7) track.sightings.back().px += Eigen::Vector2d(0.5, -0.3);
  marginaliseOldest(window, kNoneLasts);
  marginaliseOldest(other, kNoneLasts);
  const PriorFactor &prior = *window.priors.back().factor, &same = *other.priors.back().factor;
  ASSERT_EQ(window.priors.back().blocks, other.priors.back().blocks);
  EXPECT_EQ(prior.root(), same.root());
  EXPECT_EQ(prior.constant(), same.constant());
}

TEST(MarginaliseOldest, ARestingFrameTakesItsVelocityAlong) {
  SlidingWindow window = flownWindow();
  const auto informationOnVelocity = [&](bool at_rest) {
    SlidingWindow copy = window;
    copy.frames[0].at_rest = at_rest;
    marginaliseOldest(copy, kParams);
    const WindowPrior& prior = copy.priors.back();
    const NormalEquations eq = linearise(copy, {factorOf(prior)}, {{BlockKey::kMotion, 1}});
    return eq.H.topLeftCorner<3, 3>().trace();
  };
  const double of_rest = 3 / std::pow(kParams.rest_velocity_sigma, 2);  // on the velocity before the IMU turns it
  EXPECT_NEAR(informationOnVelocity(true) - informationOnVelocity(false), of_rest, 0.2 * of_rest);
}

TEST(MarginaliseSecondNewest, JoinsTheImuAndDropsTheImages) {
  SlidingWindow window = flownWindow();
  const std::size_t priors = window.priors.size();
  const double dt = window.frames[6].imu->dt_s() + window.frames[7].imu->dt_s();
  const auto shared_with_others = window.frames[6].imu;
  const double kept_dt = shared_with_others->dt_s();
  marginaliseSecondNewest(window);
  EXPECT_NEAR(window.frames[7].imu->dt_s(), dt, 1e-12);
  EXPECT_EQ(shared_with_others->dt_s(), kept_dt) << "another owner's pre-integration is not touched";
  EXPECT_EQ(window.priors.size(), priors);
  // the joined IMU goes from frame 5 to frame 7
  const Pose T_b5_w = window.frames[5].T_w_b().inverse();
  EXPECT_LT((T_b5_w.q * window.frames[7].T_w_b().q).angularDistance(window.frames[7].imu->deltaR()), 1e-4);
}

TEST(MarginaliseSecondNewest, HasNotMovedOnlyIfNeitherFrameHas) {
  for (const bool before : {false, true})
    for (const bool newest : {false, true}) {
      SlidingWindow window = flownWindow();
      window.frames[6].still = before;
      window.frames[7].still = newest;
      marginaliseSecondNewest(window);
      EXPECT_EQ(window.frames[7].still, before && newest);
    }
}

TEST(MarginaliseOldest, AFrameThatHasNotMovedSinceIsHeldByThePrior) {
  const auto informationOnPosition = [](bool still) {
    SlidingWindow window = flownWindow();
    window.frames[1].still = still;
    marginaliseOldest(window, kParams);
    const WindowPrior& prior = window.priors.back();
    const NormalEquations eq = linearise(window, {factorOf(prior)}, {{BlockKey::kPose, 1}});
    return eq.H.topLeftCorner<3, 3>().trace();
  };
  EXPECT_GT(informationOnPosition(true), informationOnPosition(false));
}

TEST(MarginaliseSecondNewest, KeepsWhatPriorsKnewThroughTheFrame) {
  SlidingWindow window = flownWindow();
  WindowPrior both;  // ties the motions of frames 5 and 6 together
  both.blocks = {{BlockKey::kMotion, 5}, {BlockKey::kMotion, 6}};
  constexpr Eigen::Index kSize = Eigen::Index{2} * kMotionSize;
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(kSize, kSize);
  const auto manifold = manifoldOf(BlockKey::kMotion);
  std::vector<PriorBlock> blocks{{manifold, window.frames[5].motion}, {manifold, window.frames[6].motion}};
  both.factor = std::make_shared<PriorFactor>(blocks, A, Eigen::VectorXd::Zero(kSize));
  window.priors = {both, motionPrior(window, 2)};
  marginaliseSecondNewest(window);
  ASSERT_EQ(window.priors.size(), 2u);
  EXPECT_TRUE(touches(window.priors[0], BlockKey::kMotion, 2));
  EXPECT_TRUE(touches(window.priors[1], BlockKey::kMotion, 5));
  EXPECT_FALSE(touches(window.priors[1], BlockKey::kMotion, 6));
}

}  // namespace
}  // namespace lintel
