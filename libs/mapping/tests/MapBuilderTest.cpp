// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapBuilder.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {
namespace {

/// Keyframes 0 to 4 along x, 0.5 m apart, looking along the world's z through a camera that is mounted turned.
class MapBuilderTest : public testing::Test {
 protected:
  MapBuilderTest() {
    params_.max_sigma_m = params_.max_relative_sigma = 0.1;  // four views from 1.5 m, that is all there is
    rig_.camera = {752, 480, 458, 457, 367, 248, -0.28, 0.07, 2e-4, 2e-5};
    rig_.T_b_c = {expRotation({0.1, 0.05, 1.5}), {-0.02, -0.06, 0.01}};
    for (FrameId id = 0; id < 5; ++id) {
      RetiredKeyframe k;
      k.id = id;
      k.t_ns = 1000 + static_cast<std::int64_t>(id) * 100;
      k.T_w_b = Pose{Eigen::Quaterniond::Identity(), {0.5 * static_cast<double>(id), 0, 0}} * rig_.T_b_c.inverse();
      update_.keyframes.push_back(k);
    }
  }

  Eigen::Vector2d pixelOf(FrameId id, const Eigen::Vector3d& p_w) const {
    return rig_.camera.project((update_.keyframes[id].T_w_b * rig_.T_b_c).inverse() * p_w);
  }
  LineSighting sightingOf(FrameId id, const Segment3& segment_w) const {
    LineSighting s;
    s.frame = id;
    s.start_px = pixelOf(id, segment_w.start);
    s.end_px = pixelOf(id, segment_w.end);
    return s;
  }
  /// A well-known line seen whole from the first `count` keyframes.
  RetiredLine lineOf(TrackId id, const Segment3& segment_w, FrameId count = 4) const {
    RetiredLine line;
    line.id = id;
    line.line_w = lineThrough(segment_w.start, segment_w.end);
    line.sigma_direction_rad = 0.01;
    line.sigma_distance_m = 0.02;
    for (FrameId k = 0; k < count; ++k) line.sightings.push_back(sightingOf(k, segment_w));
    return line;
  }
  RetiredPoint pointOf(TrackId id, const Eigen::Vector3d& p_w, FrameId count = 4) const {
    RetiredPoint point;
    point.id = id;
    point.p_w = p_w;
    point.sigma_distance_m = 0.05;
    for (FrameId k = 0; k < count; ++k) {
      PointSighting s;
      s.frame = k;
      s.px = pixelOf(k, p_w);
      point.sightings.push_back(s);
    }
    return point;
  }
  LineMap build() const {
    MapBuilder builder(rig_, params_);
    builder.add(update_);
    return builder.build();
  }

  const Segment3 upright_{{0.8, -0.7, 4}, {0.9, 0.6, 4.1}};
  Rig rig_;
  MapParams params_;
  WindowUpdate update_;
};

TEST_F(MapBuilderTest, WhatAWrongStartGaveIsTakenAway) {
  MapBuilder builder(rig_, params_);
  WindowUpdate before = update_;
  before.lines = {lineOf(3, upright_)};
  before.status = EstimatorStatus::kLost;
  builder.add(before);
  WindowUpdate wrong;
  wrong.t_ns = 5000;
  wrong.status = EstimatorStatus::kTracking;
  wrong.lines = {lineOf(4, upright_)};
  wrong.points = {pointOf(5, upright_.start)};
  wrong.keyframes = {update_.keyframes[0]};
  wrong.keyframes[0].id = 7;
  builder.add(wrong);
  WindowUpdate withdrawn;
  withdrawn.t_ns = 5100;
  withdrawn.status = EstimatorStatus::kLost;
  withdrawn.failure = Failure::kWrongStart;
  builder.add(withdrawn);
  WindowUpdate again;
  again.t_ns = 5200;
  again.status = EstimatorStatus::kTracking;
  again.replaced = {{5000, {}, {}, {}}, {5100, {}, {}, {}}};
  builder.add(again);
  const MapMaterial material = builder.material();
  EXPECT_EQ(material.keyframes.size(), 5u);
  EXPECT_TRUE(material.points.empty());
  ASSERT_EQ(material.lines.size(), 1u);
  EXPECT_EQ(material.lines[0].id, 3u);
  ASSERT_EQ(material.trajectory.size(), 3u);
  EXPECT_EQ(material.trajectory[0].first, 5000);
  EXPECT_EQ(material.trajectory[2].first, 5200);
}

TEST_F(MapBuilderTest, SegmentEndsAreWhereTheyWereSeen) {
  update_.lines = {lineOf(3, upright_)};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 1u);
  const MapLine& line = map.lines[0];
  EXPECT_EQ(line.id, 3u);
  EXPECT_LT((line.segment_w.start - upright_.start).norm(), 1e-6);
  EXPECT_LT((line.segment_w.end - upright_.end).norm(), 1e-6);
  EXPECT_EQ(line.first_t_ns, 1000);
  EXPECT_EQ(line.last_t_ns, 1300);
  ASSERT_EQ(line.observations.size(), 4u);
  EXPECT_EQ(line.observations[2].keyframe_id, 2u);
  EXPECT_LT((line.observations[2].start_px - update_.lines[0].sightings[2].start_px).norm(), 1e-4);
  EXPECT_GT(line.sigma_direction_rad, 0);
  EXPECT_LT(line.sigma_direction_rad, 0.05);
  EXPECT_GT(line.sigma_distance_m, 0);
  EXPECT_LT(line.sigma_distance_m, 0.05);
}

TEST_F(MapBuilderTest, StartAndEndKeepTheOrderOfTheObservations) {
  RetiredLine line = lineOf(3, {upright_.end, upright_.start});
  line.line_w = lineThrough(upright_.start, upright_.end);  // the estimate's direction is arbitrary
  update_.lines = {line};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 1u);
  EXPECT_LT((map.lines[0].segment_w.start - upright_.end).norm(), 1e-6);
}

TEST_F(MapBuilderTest, AnOutlierDoesNotLengthenASegment) {
  RetiredLine line = lineOf(3, upright_);
  const Eigen::Vector3d beyond = upright_.end + 0.8 * (upright_.end - upright_.start);
  line.sightings[1].end_px = pixelOf(1, beyond);
  update_.lines = {line};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 1u);
  EXPECT_NEAR(map.lines[0].segment_w.length(), upright_.length(), 1e-6);
}

TEST_F(MapBuilderTest, PiecesSeenOneAfterTheOtherAddUp) {
  const auto piece = [&](double from, double to) {
    const Eigen::Vector3d d = upright_.end - upright_.start;
    return Segment3{upright_.start + from * d, upright_.start + to * d};
  };
  RetiredLine line = lineOf(3, upright_, 0);
  line.sightings = {sightingOf(0, piece(0, 0.5)), sightingOf(1, piece(0, 0.7)), sightingOf(2, piece(0.4, 1)),
                    sightingOf(3, piece(0.5, 1))};
  update_.lines = {line};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 1u);
  EXPECT_NEAR(map.lines[0].segment_w.length(), upright_.length(), 1e-6);
}

TEST_F(MapBuilderTest, LinesWithoutEvidenceAreLeftOut) {
  // beside each other, farther apart than what is merged
  const auto beside = [&](double x) {
    return Segment3{upright_.start + Eigen::Vector3d(x, 0, 0), upright_.end + Eigen::Vector3d(x, 0, 0)};
  };
  RetiredLine few = lineOf(2, beside(-0.4), 2), dot = lineOf(6, {{0.4, 0, 4}, {0.4, 0.01, 4}}),
              good = lineOf(7, upright_),
              along = lineOf(8, {{0.2, 0.5, 4}, {1.4, 0.5, 4}}),  // in the plane of the flight: depth unknown
      torn = lineOf(9, beside(0.4));
  for (std::size_t i = 1; i < 3; ++i) {  // half of its views are of other things
    torn.sightings[i].start_px.x() += 40.0 * static_cast<double>(i);
    torn.sightings[i].end_px.x() -= 55;
  }
  update_.lines = {few, dot, good, along, torn};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 1u);
  EXPECT_EQ(map.lines[0].id, 7u);
}

/// Five parallel lines, and a sixth that few views show badly: use | drop | constrain.
TEST_F(MapBuilderTest, DegenerateLinesAreUsedDroppedOrConstrained) {
  const auto parallel = [](double x, double y, double length) {
    return Segment3{{x, y, 3}, {x + length, y + 0.3 * length, 3}};
  };
  for (TrackId id = 1; id <= 5; ++id)
    update_.lines.push_back(
        lineOf(id, parallel(0.2 * static_cast<double>(id), 0.3 * static_cast<double>(id) - 1.2, 1)));
  const Segment3 degenerate_w = parallel(0.2, -1.2, 0.4);
  RetiredLine line = lineOf(9, degenerate_w, 3);
  for (std::size_t i = 0; i < 3; ++i) line.sightings[i].end_px.y() += i % 2 ? 1 : -1;
  line.group = 1;
  update_.lines.push_back(line);
  params_.max_sigma_m = 0.2;
  params_.groups.max_angle_rad = 0.1;
  const auto find = [&](const char* what) {
    params_.degenerate_lines = what;
    for (const MapLine& l : build().lines)
      if (l.id == 9) return std::make_optional(l);
    return std::optional<MapLine>();
  };
  const auto used = find("use"), dropped = find("drop"), constrained = find("constrain");
  ASSERT_TRUE(used);
  EXPECT_TRUE(used->degenerate && !used->constrained);
  EXPECT_FALSE(dropped);
  ASSERT_TRUE(constrained);
  EXPECT_TRUE(constrained->degenerate && constrained->constrained);
  const auto error = [&](const MapLine& l) { return lineAngle(l.segment_w.direction(), degenerate_w.direction()); };
  EXPECT_LT(error(*constrained), 0.03);
  EXPECT_LT(3 * error(*constrained), error(*used));
}

TEST_F(MapBuilderTest, WhatTheWindowCouldNotPlaceIsEstimatedFromAllViews) {
  RetiredLine line = lineOf(3, upright_), degenerate = lineOf(4, {{1.4, -0.7, 4}, {1.4, 0.6, 4}});
  line.triangulated = false;
  line.line_w = {};
  degenerate.degenerate = true;
  RetiredPoint point = pointOf(5, {0.5, 0.2, 4});
  point.triangulated = false;
  point.p_w.setZero();
  update_.lines = {line, degenerate};
  update_.points = {point};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 2u);
  EXPECT_LT((map.lines[0].segment_w.start - upright_.start).norm(), 1e-6);
  ASSERT_EQ(map.points.size(), 1u);
  EXPECT_LT((map.points[0].p_w - Eigen::Vector3d(0.5, 0.2, 4)).norm(), 1e-6);
}

TEST_F(MapBuilderTest, PiecesOfOneEdgeBecomeOneSegmentWithAllObservations) {
  const Eigen::Vector3d middle = upright_.midpoint();
  update_.lines = {lineOf(9, {upright_.start, middle}), lineOf(4, {upright_.end, middle})};
  EXPECT_EQ(build().lines.size(), 2u) << "contrast changes at the middle";
  MapBuilder builder(rig_, params_);
  builder.add(update_);
  MapMaterial material = builder.takeMaterial();
  prepareMaterial(params_, material);
  settleLines(params_, material);
  const LineMap map = drawMap(params_, material);
  ASSERT_EQ(map.lines.size(), 1u);
  EXPECT_EQ(map.lines[0].id, 4u);
  EXPECT_NEAR(map.lines[0].segment_w.length(), upright_.length(), 1e-3);
  ASSERT_EQ(map.lines[0].observations.size(), 8u);
  const Eigen::Vector2d along = pixelOf(0, map.lines[0].segment_w.end) - pixelOf(0, map.lines[0].segment_w.start);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_GT(along.dot(map.lines[0].observations[i].end_px - map.lines[0].observations[i].start_px), 0)
        << "starts and ends correspond, whichever way the track ran";
}

TEST_F(MapBuilderTest, PointsWithoutEvidenceAreLeftOut) {
  RetiredPoint few = pointOf(1, {0.5, 0.2, 4}, 2), vague = pointOf(2, {0.5, 0.2, 150}),
               good = pointOf(3, {0.6, 0.1, 5});
  update_.points = {few, vague, good};
  const LineMap map = build();
  ASSERT_EQ(map.points.size(), 1u);
  EXPECT_EQ(map.points[0].id, 3u);
  EXPECT_LT((map.points[0].p_w - Eigen::Vector3d(0.6, 0.1, 5)).norm(), 1e-6);
  EXPECT_EQ(map.points[0].first_t_ns, 1000);
  EXPECT_EQ(map.points[0].last_t_ns, 1300);
  EXPECT_EQ(map.points[0].observations.size(), 4u);
}

TEST_F(MapBuilderTest, SightingsInFramesThatAreNoKeyframesDoNotCount) {
  RetiredLine line = lineOf(1, upright_, 3);
  for (FrameId unknown : {70u, 71u}) {
    line.sightings.push_back(line.sightings[0]);
    line.sightings.back().frame = unknown;
  }
  update_.lines = {line};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 1u);
  EXPECT_EQ(map.lines[0].observations.size(), 3u);
  EXPECT_EQ(map.lines[0].last_t_ns, 1200);
}

TEST_F(MapBuilderTest, IdsAscendInEveryList) {
  update_.lines = {lineOf(9, upright_), lineOf(2, {{0.2, -0.7, 3}, {0.2, 0.6, 3}}),
                   lineOf(5, {{1.4, -0.7, 4}, {1.4, 0.6, 4}})};
  update_.points = {pointOf(8, {0.5, 0.2, 4}), pointOf(1, {0.6, 0.1, 5})};
  std::swap(update_.keyframes[0], update_.keyframes[4]);
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 3u);
  EXPECT_LT(map.lines[0].id, map.lines[1].id);
  EXPECT_LT(map.lines[1].id, map.lines[2].id);
  ASSERT_EQ(map.points.size(), 2u);
  EXPECT_LT(map.points[0].id, map.points[1].id);
  ASSERT_EQ(map.keyframes.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(map.keyframes[i].id, i);
}

TEST_F(MapBuilderTest, ATrackThatOutlivesARestartGetsAnIdOfItsOwn) {
  // after a failure the estimator has a new world: the same track is handed over again, as another line and point
  update_.lines = {lineOf(5, upright_), lineOf(9, {{1.4, -0.7, 4}, {1.4, 0.6, 4}}),
                   lineOf(5, {{0.2, -0.7, 3}, {0.2, 0.6, 3}})};
  update_.points = {pointOf(5, {0.5, 0.2, 4}), pointOf(5, {0.6, 0.1, 5}), pointOf(6, {0.6, 0.3, 5})};
  const LineMap map = build();
  ASSERT_EQ(map.lines.size(), 3u);
  ASSERT_EQ(map.points.size(), 3u);
  std::set<std::uint64_t> lines, points;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(lines.insert(map.lines[i].id).second) << map.lines[i].id;
    EXPECT_TRUE(points.insert(map.points[i].id).second) << map.points[i].id;
    if (i > 0) {
      EXPECT_TRUE(map.lines[i - 1].id < map.lines[i].id && map.points[i - 1].id < map.points[i].id);
    }
  }
  EXPECT_LT((map.lines[0].segment_w.start - upright_.start).norm(), 1e-6) << "the first keeps its id";
  EXPECT_EQ(map.lines[0].id, 5u);
}

TEST_F(MapBuilderTest, AnHourWithoutNewsCostsThePosesOnly) {
  MapBuilder builder(rig_, params_);
  builder.add(update_);
  WindowUpdate frame;
  frame.status = EstimatorStatus::kTracking;
  constexpr std::size_t kFrames = 72'000;
  const auto used = [] {
    const struct mallinfo2 heap = ::mallinfo2();
    return heap.uordblks + heap.hblkhd;
  };
  const std::size_t before = used();
  for (std::size_t i = 0; i < kFrames; ++i) {
    frame.t_ns = static_cast<std::int64_t>(i);
    builder.add(frame);
  }
  constexpr std::size_t kPose = sizeof(std::pair<std::int64_t, Pose>);
  EXPECT_LE(used() - before, 2 * kFrames * kPose + 1'000'000) << "a list grows by doubling";
  EXPECT_EQ(builder.material().trajectory.size(), kFrames);
}

/// The keyframe at `t` seconds of a flight with an acceleration along x from rest, with the IMU since `imu_from`.
RetiredKeyframe acceleratedKeyframe(FrameId id, double t, double acceleration, std::optional<double> imu_from) {
  RetiredKeyframe keyframe;
  keyframe.id = id;
  keyframe.t_ns = std::llround(1e9 * t);
  keyframe.T_w_b.p = {0.5 * acceleration * t * t, 0, 0};
  keyframe.v_w_b = {acceleration * t, 0, 0};
  if (!imu_from) return keyframe;
  ImuBatch samples;
  for (std::int64_t t_ns = std::llround(1e9 * *imu_from); t_ns <= keyframe.t_ns; t_ns += 5'000'000)
    samples.push_back({t_ns, {0, 0, 0}, {acceleration, 0, kGravity}});
  const auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
  imu->append(samples);
  keyframe.imu = imu;
  return keyframe;
}

TEST_F(MapBuilderTest, FramesThatAStartWasMadeOfHavePoses) {
  constexpr double kAcceleration = 2;
  MapBuilder builder(rig_, params_);
  const auto add = [&](int tenth, bool pose, const std::vector<RetiredKeyframe>& keyframes = {}) {
    WindowUpdate update;
    update.t_ns = tenth * 100'000'000LL;
    update.status = pose ? EstimatorStatus::kTracking : EstimatorStatus::kInitializing;
    update.T_w_b.p = {0.5 * kAcceleration * 0.01 * tenth * tenth, 0, 0};
    update.keyframes = keyframes;
    builder.add(update);
  };
  // two starts: of the frames from 0.1 to 0.5 s, and of those from 0.8 to 1.1 s, with the IMU interrupted between them
  for (int tenth = 0; tenth < 5; ++tenth) add(tenth, false);
  add(5, true,
      {acceleratedKeyframe(1, 0.1, kAcceleration, {}), acceleratedKeyframe(2, 0.3, kAcceleration, 0.1),
       acceleratedKeyframe(3, 0.5, kAcceleration, 0.3)});
  for (int tenth = 6; tenth < 11; ++tenth) add(tenth, false);
  add(11, true, {acceleratedKeyframe(4, 0.8, kAcceleration, {}), acceleratedKeyframe(5, 1.1, kAcceleration, 0.8)});
  const MapMaterial material = builder.material();
  std::vector<int> tenths;
  for (const auto& [t_ns, T_w_b] : material.trajectory) {
    tenths.push_back(static_cast<int>(t_ns / 100'000'000));
    const double t = 1e-9 * static_cast<double>(t_ns);
    EXPECT_LT((T_w_b.p - Eigen::Vector3d(0.5 * kAcceleration * t * t, 0, 0)).norm(), 1e-9) << t;
  }
  EXPECT_EQ(tenths, (std::vector<int>{1, 2, 3, 4, 5, 8, 9, 10, 11})) << "before a start and between them there is none";
  ASSERT_EQ(material.pieces.size(), 2u);
  EXPECT_EQ(material.pieces[1].first_pose, 5u);
}

TEST_F(MapBuilderTest, KeepsTheTrajectoryAndTheLastRig) {
  MapBuilder builder(rig_, params_);
  WindowUpdate a, b, c;
  a.t_ns = 1;
  a.status = EstimatorStatus::kTracking;
  a.T_w_b.p = {1, 2, 3};
  b.t_ns = 2;
  b.status = EstimatorStatus::kInitializing;
  c.t_ns = 3;
  c.status = EstimatorStatus::kPropagated;
  for (const WindowUpdate& update : {a, b, c}) builder.add(update);
  Rig refined = rig_;
  refined.camera.fx += 1;
  builder.setCalibration(refined);
  const LineMap map = builder.build();
  ASSERT_EQ(map.trajectory.size(), 2u);
  EXPECT_EQ(map.trajectory[0].first, 1);
  EXPECT_EQ(map.trajectory[0].second.p, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(map.trajectory[1].first, 3);
  EXPECT_EQ(map.rig.camera.fx, refined.camera.fx);
}

}  // namespace
}  // namespace lintel
