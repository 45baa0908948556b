// SPDX-License-Identifier: BSD-3-Clause
// What can be said of two maps without a flight; LintelMapMergeTest merges those of flights.
#include "lintel/pipeline/MapMerging.h"

#include <gmock/gmock.h>

#include <functional>

#include "MapTimes.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000, kDay = 86400 * kSecond;

/// Three keyframes a second apart, one view, two poses a keyframe.
LineMap smallMap(std::int64_t from_ns, const std::string& source) {
  LineMap map;
  map.source = source;
  map.rig.camera = {752, 480, 458, 457, 367, 248, -0.28, 0.07, 2e-4, 2e-5};
  for (std::uint64_t id = 0; id < 3; ++id) {
    MapKeyframe keyframe;
    keyframe.id = id;
    keyframe.t_ns = from_ns + static_cast<std::int64_t>(id) * kSecond;
    if (id > 0) {
      auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
      imu->append({{keyframe.t_ns - kSecond, {0, 0, 0}, {0, 0, 9.81}}, {keyframe.t_ns, {0, 0, 0}, {0, 0, 9.81}}});
      keyframe.imu = imu;
    }
    map.trajectory.emplace_back(keyframe.t_ns, Pose{});
    map.trajectory.emplace_back(keyframe.t_ns + kSecond / 2, Pose{});
    map.keyframes.push_back(keyframe);
  }
  map.points.push_back({4, {0, 0, 5}, 0.1, from_ns, from_ns + 2 * kSecond, {{0, {1, 2}}, {2, {3, 4}}}});
  map.pieces = {{0, from_ns, from_ns + 2 * kSecond, 0, 0, 0}};
  map.views.push_back({0, {from_ns, {}}});
  return map;
}

TEST(MapMerging, OneRunIsNotMergedWithItself) {
  EXPECT_THAT(mergeMaps(smallMap(5, "a"), smallMap(5, "a"), {}).refusal, HasSubstr("map of one run"));
}

TEST(MapMerging, WithoutViewsAPlaceCannotBeFound) {
  LineMap without = smallMap(5, "b");
  without.views.clear();
  EXPECT_THAT(mergeMaps(smallMap(7, "a"), without, {}).refusal, HasSubstr("the second one keeps no views"));
  EXPECT_THAT(mergeMaps(without, smallMap(7, "a"), {}).refusal, HasSubstr("loops.keep_interval_s"));
}

TEST(MapMerging, OneCameraIsAssumed) {
  LineMap other = smallMap(5, "b");
  other.rig.camera.fx = other.rig.camera.fy = 600;
  EXPECT_THAT(mergeMaps(smallMap(7, "a"), other, {}).refusal, HasSubstr("different cameras"));
  other = smallMap(5, "b");
  other.rig.T_b_c.q = Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitX()));
  EXPECT_THAT(mergeMaps(smallMap(7, "a"), other, {}).refusal, HasSubstr("different cameras"));
}

TEST(MapMerging, NumbersThatNoFlightHasAreRefused) {
  const std::vector<std::function<void(LineMap&)>> damages{
      [](LineMap& m) { m.rig.camera.fx = 0; },
      [](LineMap& m) { m.rig.T_b_c.q.coeffs().setZero(); },
      [](LineMap& m) { m.keyframes[1].T_w_b.p.x() = std::nan(""); },
      [](LineMap& m) { m.keyframes[1].v_w_b.x() = 1e300; },
      [](LineMap& m) { m.trajectory[2].second.q.coeffs() *= 2; },
      [](LineMap& m) { m.pieces[0].last_ns += 100 * kDay; },
      [](LineMap& m) { m.keyframes[1].t_ns += 2 * kDay; },
      [](LineMap& m) { m.trajectory[2].first -= 2 * kDay; },
      [](LineMap& m) { m.views[0].looks.t_ns -= 2 * kDay; }};
  for (const auto& damage : damages) {
    LineMap damaged = smallMap(5, "b");
    damage(damaged);
    EXPECT_THAT(mergeMaps(smallMap(7, "a"), damaged, {}).refusal, HasSubstr("out of range"));
  }
}

TEST(MapMerging, WithoutACommonPlaceThereIsNoMap) {
  const MapMerging merging = mergeMaps(smallMap(7, "a"), smallMap(5, "b"), {});
  EXPECT_THAT(merging.refusal, HasSubstr("no place of the second is recognised"));
  EXPECT_TRUE(merging.map.keyframes.empty());
}

TEST(MapMerging, RecordingsOfOneTimeAreTakenBehindOneAnotherMeanwhile) {
  const LineMap before = smallMap(1000 * kSecond, "b");
  LineMap map = before;
  map.pieces[0].recording = 1;
  const MapPiece other{0, 999 * kSecond, 1001 * kSecond, 0, 0, 0};
  std::vector<std::int64_t> by_ns = timesBehindOneAnother({other, map.pieces[0]});
  ASSERT_EQ(by_ns.size(), 2u);
  EXPECT_EQ(by_ns[0], 0);
  moveTimes(by_ns, map);
  EXPECT_GT(map.keyframes.front().t_ns, other.last_ns + 50 * kSecond);
  EXPECT_EQ(map.keyframes[1].imu->samples().back().t_ns, map.keyframes[1].t_ns);
  for (std::int64_t& by : by_ns) by = -by;
  moveTimes(by_ns, map);
  EXPECT_EQ(map.keyframes[2].t_ns, before.keyframes[2].t_ns);
  EXPECT_EQ(map.keyframes[2].imu->samples()[0].t_ns, before.keyframes[2].imu->samples()[0].t_ns);
  EXPECT_EQ(map.trajectory[5].first, before.trajectory[5].first);
  EXPECT_EQ(map.points[0].last_t_ns, before.points[0].last_t_ns);
  EXPECT_EQ(map.views[0].looks.t_ns, before.views[0].looks.t_ns);
  EXPECT_EQ(map.pieces[0].last_ns, before.pieces[0].last_ns);
}

TEST(MapMerging, TheTrajectoryOfARecordingIsThatOfItsPieces) {
  LineMap map = smallMap(5, "a");
  map.pieces = {
      {0, 5, 5, 0, 0, 0}, {1, 5 + kSecond, 5 + kSecond, 2, 0, 1}, {2, 5 + 2 * kSecond, 5 + 2 * kSecond, 4, 0, 0}};
  EXPECT_EQ(trajectoryOf(map, 0).size(), 4u);
  ASSERT_EQ(trajectoryOf(map, 1).size(), 2u);
  EXPECT_EQ(trajectoryOf(map, 1).front().first, 5 + kSecond);
  EXPECT_TRUE(trajectoryOf(map, 2).empty());
}

}  // namespace
}  // namespace lintel
