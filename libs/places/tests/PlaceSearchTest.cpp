// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/places/PlaceSearch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "SyntheticPlaces.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using namespace test;

constexpr TrackId kSecondVisit = 10000;

/// Five quarters of the square, 40 s long; the last quarter is the first one again.
SyntheticPlaces flight(const Pose& drift) {
  SyntheticPlaces world;
  for (int k = 0; k < 200; ++k) {
    const double side = k / 40.0;
    const bool again = side >= 4;
    world.add(0.2 * k, SyntheticPlaces::poseAt(again ? side - 4 : side), again ? drift : Pose{},
              again ? kSecondVisit : 0, world.landmarks(), 8 * side);
  }
  return world;
}

std::vector<PlacePair> accepted(const PlaceReport& report) {
  std::vector<PlacePair> pairs;
  std::copy_if(report.pairs.begin(), report.pairs.end(), std::back_inserter(pairs),
               [](const PlacePair& p) { return p.refusal.empty(); });
  return pairs;
}

TEST(PlaceSearch, FindsAPlaceAgainAlthoughTheOdometryHasDriftedFar) {
  const Pose drift{Eigen::Quaterniond(Eigen::AngleAxisd(0.17, Eigen::Vector3d::UnitZ())), {2, -2, 1}};
  const SyntheticPlaces world = flight(drift);
  const PlaceReport report = findPlaces(world.camera, world.keyframes, world.points_w, {});
  EXPECT_EQ(report.described, 200u);
  const std::vector<PlacePair> pairs = accepted(report);
  std::set<std::int64_t> later;
  for (const PlacePair& pair : pairs) {
    later.insert(pair.later_ns);
    EXPECT_GE(pair.later_ns - pair.earlier_ns, 10'000'000'000);
    const auto at = static_cast<std::size_t>(pair.later_ns / 200'000'000);
    ASSERT_GE(at, 160u) << "only the last quarter is seen again";
    const Pose truth = drift.inverse() * world.keyframes[at].T_w_c;
    EXPECT_LT((pair.T_w_c.p - truth.p).norm(), 0.02);
    EXPECT_NEAR(pair.drift_m, (pair.T_w_c.p - world.keyframes[at].T_w_c.p).norm(), 1e-9);
    EXPECT_NEAR(pair.drift_rad, 0.17, 0.01);
  }
  EXPECT_GE(later.size(), 36u) << "of 40 keyframes";
}

TEST(PlaceSearch, TracksOfOnePointAreFoundAndNoOthers) {
  const SyntheticPlaces world = flight({Eigen::Quaterniond::Identity(), {0.3, 0.1, 0}});
  const PlaceReport report = findPlaces(world.camera, world.keyframes, world.points_w, {});
  EXPECT_GT(report.same.size(), 100u);
  for (const SamePoint& same : report.same) EXPECT_EQ(same.later, same.earlier + kSecondVisit);
}

TEST(PlaceSearch, NeighboursInTimeAreNoLoop) {
  SyntheticPlaces world;
  for (int k = 0; k < 45; ++k)  // at rest for 9 s
    world.add(0.2 * k, SyntheticPlaces::poseAt(0.5), {}, k < 20 ? 0 : kSecondVisit, world.landmarks(), 0);
  EXPECT_TRUE(findPlaces(world.camera, world.keyframes, world.points_w, {}).pairs.empty());
}

/// The same flight, interrupted after three quarters of the square: the rest has another world and begins at
/// `gap_s` later.
SyntheticPlaces interrupted(const Pose& drift, double gap_s) {
  SyntheticPlaces world;
  for (int k = 0; k < 160; ++k) {
    const double side = k / 40.0;
    const bool rest = k >= 120;
    world.add(0.2 * k + (rest ? gap_s : 0), SyntheticPlaces::poseAt(rest ? side - 3 : side), rest ? drift : Pose{},
              rest ? kSecondVisit : 0, world.landmarks(), 8 * side);
    world.keyframes.back().run = rest ? 1 : 0;
  }
  return world;
}

TEST(PlaceSearch, ThePiecesOfAnInterruptedFlightAreBroughtTogether) {
  const Pose drift{Eigen::Quaterniond(Eigen::AngleAxisd(-2, Eigen::Vector3d::UnitZ())), {1, 5, 0}};
  const SyntheticPlaces world = interrupted(drift, 3);
  const PlaceReport report = findPlaces(world.camera, world.keyframes, world.points_w, {});
  ASSERT_EQ(report.alignments.size(), 1u);
  const RunAlignment& alignment = report.alignments[0];
  EXPECT_EQ(alignment.run, 1);
  EXPECT_EQ(alignment.world, 0);
  EXPECT_GE(alignment.keyframes, 30);
  const Pose error = alignment.world_from_run * drift;
  EXPECT_LT(error.p.norm(), 0.02);
  EXPECT_LT(logRotation(error.q).norm(), 0.003);
  EXPECT_GT(report.same.size(), 100u);
  for (const SamePoint& same : report.same) EXPECT_EQ(same.later, same.earlier + kSecondVisit);
}

TEST(PlaceSearch, APieceThatWasNeverThereBeforeStaysAlone) {
  SyntheticPlaces world, elsewhere(17);
  for (int k = 0; k < 80; ++k) {
    const bool rest = k >= 40;
    world.add(0.2 * k, SyntheticPlaces::poseAt((k % 40) / 40.0), {}, rest ? kSecondVisit : 0,
              rest ? elsewhere.landmarks() : world.landmarks(), 8 * k / 40.0);
    world.keyframes.back().run = rest ? 1 : 0;
  }
  const PlaceReport report = findPlaces(world.camera, world.keyframes, world.points_w, {});
  EXPECT_TRUE(report.alignments.empty());
  EXPECT_TRUE(report.same.empty());
}

TEST(PlaceSearch, APieceCannotBeginFartherOffThanCanBeFlown) {
  PlaceParams params;
  params.max_drift_m = params.max_drift_share = 0;
  const SyntheticPlaces soon = interrupted({}, 0);  // from one corner to another, 5 m, in 0.2 s
  EXPECT_TRUE(findPlaces(soon.camera, soon.keyframes, soon.points_w, params).alignments.empty());
  const SyntheticPlaces later = interrupted({}, 20);
  EXPECT_FALSE(findPlaces(later.camera, later.keyframes, later.points_w, params).alignments.empty());
}

TEST(PlaceSearch, ARoomThatLooksTheSameElsewhereIsAnotherRoom) {
  SyntheticPlaces world;
  std::vector<Landmark> copy = world.landmarks();
  const Pose elsewhere{Eigen::Quaterniond::Identity(), {30, 0, 0}};
  for (Landmark& landmark : copy) landmark.p_w += elsewhere.p;
  for (int k = 0; k < 160; ++k) {
    const bool other = k >= 80;
    const Pose T = SyntheticPlaces::poseAt((k % 80) / 40.0);
    world.add(0.2 * k, other ? elsewhere * T : T, {}, other ? kSecondVisit : 0, other ? copy : world.landmarks(),
              0.4 * k);
  }
  const PlaceReport report = findPlaces(world.camera, world.keyframes, world.points_w, {});
  EXPECT_TRUE(accepted(report).empty());
  EXPECT_TRUE(report.same.empty());
  ASSERT_FALSE(report.pairs.empty());
  EXPECT_EQ(report.pairs.front().refusal, "the odometry cannot have drifted so far");
}

TEST(PlaceSearch, TheSameThingsArrangedDifferentlyAreAnotherPlace) {
  SyntheticPlaces world;
  std::vector<Landmark> other = world.landmarks();
  std::mt19937 random(5);
  std::shuffle(other.begin(), other.end(), random);
  for (std::size_t i = 0; i < other.size(); ++i) other[i].p_w = world.landmarks()[i].p_w;
  for (int k = 0; k < 160; ++k)
    world.add(0.2 * k, SyntheticPlaces::poseAt((k % 80) / 40.0), {}, k >= 80 ? kSecondVisit : 0,
              k >= 80 ? other : world.landmarks(), 0.2 * k);
  EXPECT_TRUE(accepted(findPlaces(world.camera, world.keyframes, world.points_w, {})).empty());
}

TEST(PlaceSearch, OneKeyframeAloneIsNotBelieved) {
  SyntheticPlaces world;
  for (int k = 0; k < 80; ++k) world.add(0.2 * k, SyntheticPlaces::poseAt(k / 40.0), {}, 0, world.landmarks(), 0.2 * k);
  world.add(40, SyntheticPlaces::poseAt(0.5), {}, kSecondVisit, world.landmarks(), 16);
  const PlaceReport report = findPlaces(world.camera, world.keyframes, world.points_w, {});
  EXPECT_TRUE(accepted(report).empty());
  ASSERT_FALSE(report.pairs.empty());
  EXPECT_EQ(report.pairs.front().refusal, "keyframes beside it do not find the same drift");
}

TEST(PlaceSearch, ItTellsHowFarItIsAndEndsWhenAsked) {
  const SyntheticPlaces world = flight({});
  std::vector<double> told;
  const auto until = [&](double most) {
    told.clear();
    return findPlaces(world.camera, world.keyframes, world.points_w, {}, [&](double share) {
      told.push_back(share);
      return share < most;
    });
  };
  EXPECT_FALSE(until(2).pairs.empty());
  EXPECT_EQ(told.size(), 200u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_TRUE(until(0.5).pairs.empty());
  EXPECT_EQ(told.size(), 101u);
}

TEST(PlaceSearch, AnAbsurdParameterIsRefusedByName) {
  PlaceParams params;
  params.min_points = 0;
  EXPECT_THROW(findPlaces(placeCamera(), {}, {}, params), std::invalid_argument);
}

TEST(PlaceSearch, NothingIsFoundInNothing) {
  const PlaceReport report = findPlaces(placeCamera(), {}, {}, {});
  EXPECT_TRUE(report.pairs.empty());
  SyntheticPlaces dark;
  for (int k = 0; k < 100; ++k) dark.add(0.2 * k, SyntheticPlaces::poseAt(0), {}, 0, {}, 0);
  EXPECT_TRUE(findPlaces(dark.camera, dark.keyframes, dark.points_w, {}).pairs.empty()) << "views without features";
}

}  // namespace
}  // namespace lintel
