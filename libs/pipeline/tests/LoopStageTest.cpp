// SPDX-License-Identifier: BSD-3-Clause
#include "LoopStage.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace lintel {
namespace {

/// A camera that looks at a wall of random squares 4 m away and moves sideways along it, there and back.
class LoopStageTest : public testing::Test {
 protected:
  static constexpr double kWall_m = 4, kPixels_m = 100;

  /// Place of a pixel in an image of that width.
  static std::size_t at(int u, int v, int wide) {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(wide) + static_cast<std::size_t>(u);
  }

  LoopStageTest() {
    rig_.camera = {752, 480, 400, 400, 376, 240, 0, 0, 0, 0};
    rig_.T_b_c.q = Eigen::Quaterniond(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()));  // y down, z forward
    std::mt19937 random(9);
    wall_.resize(at(0, kHigh, kWide));
    for (int i = 0; i < 6000; ++i) {
      const int x = static_cast<int>(random() % (kWide - 40)), y = static_cast<int>(random() % (kHigh - 40));
      const int wide = 8 + static_cast<int>(random() % 30), high = 8 + static_cast<int>(random() % 30);
      const auto grey = static_cast<std::uint8_t>(random());
      for (int v = y; v < y + high; ++v)
        for (int u = x; u < x + wide; ++u) wall_[at(u, v, kWide)] = grey;
    }
  }

  /// Position along the wall: 0.25 m/s for 12 s, and back.
  static double along(double t_s) { return 0.25 * (t_s < 12 ? t_s : 24 - t_s); }

  Frame frameAt(std::int64_t t_ns, double x_m) const {
    auto image = std::make_shared<GrayImage>();
    *image = {752, 480, std::vector<std::uint8_t>(at(0, 480, 752))};
    const int shift = static_cast<int>(std::lround(x_m * kPixels_m));
    for (int v = 0; v < 480; ++v)
      for (int u = 0; u < 752; ++u) image->pixels[at(u, v, 752)] = wall_[at(u + shift, v, kWide)];
    return {t_ns, image};
  }

  /// Points every 0.3 m on the wall; those seen on the way back are other tracks, their world is drifted. The way back
  /// is another piece when the flight was `interrupted`.
  LoopResult fly(LoopStage& stage, double drift_m, MapMaterial& material, bool interrupted = false) {
    material.rig = rig_;
    std::map<TrackId, PointRecord> points;
    for (int i = 0; i < 240; ++i) {
      const std::int64_t t_ns = i * std::int64_t{100'000'000};
      const double t_s = 0.1 * i, x_m = along(t_s), drift = t_s < 12 ? 0 : drift_m;
      WindowUpdate update;
      update.t_ns = t_ns;
      update.status = EstimatorStatus::kTracking;
      update.T_w_b.p = {x_m + drift, 0, 0};
      material.trajectory.emplace_back(t_ns, update.T_w_b);
      std::vector<PointObservation> tracked;
      for (int k = 0; k < 400; ++k) {
        const int column = k % 40, row = k / 40;
        const Eigen::Vector3d p_w(0.3 * column - 2, kWall_m, 0.3 * row - 1.5);
        const Eigen::Vector3d p_c = rig_.T_b_c.inverse() * (p_w - Eigen::Vector3d(x_m, 0, 0));
        const Eigen::Vector2d px = rig_.camera.project(p_c);
        if (!rig_.camera.contains(px, 20)) continue;
        const TrackId id = static_cast<TrackId>(k) + (t_s < 12 ? 0 : kBack);
        tracked.push_back({id, px, p_c, 1});
        points[id].id = id;
        points[id].known = true;
        points[id].p_w = p_w + Eigen::Vector3d(drift, 0, 0);
        points[id].views.push_back({static_cast<std::uint32_t>(i), px.cast<float>(), true});
      }
      if (interrupted && i == 120) {
        WindowUpdate lost;
        lost.status = EstimatorStatus::kLost;
        stage.add(frameAt(t_ns, x_m), {}, lost);
      }
      stage.add(frameAt(t_ns, x_m), tracked, update);
    }
    for (auto& [id, point] : points) material.points.push_back(point);
    return stage.find(material, {});
  }

  static constexpr int kWide = 1200, kHigh = 480;
  static constexpr TrackId kBack = 1000;
  static constexpr std::int64_t kTurn_ns = 12'000'000'000;
  Rig rig_;
  std::vector<std::uint8_t> wall_;
};

TEST_F(LoopStageTest, FramesOfAWrongStartAreForgotten) {
  LoopStage stage(rig_, {});
  MapMaterial material;
  fly(stage, 0, material);
  WindowUpdate wrong;
  wrong.status = EstimatorStatus::kLost;
  wrong.failure = Failure::kWrongStart;
  stage.add(frameAt(0, 0), {}, wrong);
  EXPECT_EQ(stage.find(material, {}).places.described, 0u);
}

TEST_F(LoopStageTest, TheWayBackIsSeenAgainAndTheDriftIsMeasured) {
  PlaceParams params;
  params.interval_s = 0.4;
  params.min_separation_s = 14;
  LoopStage stage(rig_, params);
  MapMaterial material;
  LoopResult loops = fly(stage, 0.2, material);
  EXPECT_TRUE(loops.searched);
  EXPECT_EQ(loops.places.described, 60u);
  ASSERT_GT(loops.drift_before_m.size(), 20u);
  for (const PlacePair& pair : loops.places.pairs) EXPECT_NEAR(pair.drift_m, 0.2, 0.03);
  const std::vector<PointJoin> joins = joinsOf(loops);
  EXPECT_GT(joins.size(), 50u);
  for (const PointJoin& join : joins) EXPECT_EQ(join.b, join.a + kBack);

  for (auto& [t_ns, T_w_b] : material.trajectory)
    if (t_ns >= kTurn_ns) T_w_b.p.x() -= 0.2;  // as a refinement would
  stage.measureDrift(material, loops);
  ASSERT_EQ(loops.drift_after_m.size(), loops.drift_before_m.size());
  for (const double drift_m : loops.drift_after_m) EXPECT_LT(drift_m, 0.03);
}

TEST_F(LoopStageTest, AnInterruptedFlightIsBroughtTogether) {
  PlaceParams params;
  params.interval_s = 0.4;
  params.min_separation_s = 14;
  LoopStage stage(rig_, params);
  MapMaterial material;
  material.pieces = {{0, 0, kTurn_ns - 1, 0, 0, 0}, {120, kTurn_ns, 2 * kTurn_ns, 120, 1, 0}};
  const LoopResult loops = fly(stage, 1.5, material, true);
  EXPECT_TRUE(loops.drift_before_m.empty()) << "between pieces there is none";
  ASSERT_EQ(loops.places.alignments.size(), 1u);
  alignPieces(loops.places.alignments, material);
  EXPECT_EQ(material.pieces[1].world, 0);
  for (const auto& [t_ns, T_w_b] : material.trajectory)
    EXPECT_NEAR(T_w_b.p.x(), along(1e-9 * static_cast<double>(t_ns)), 0.03);
  for (const PointRecord& point : material.points)
    EXPECT_NEAR(point.p_w.x(), 0.3 * static_cast<double>(point.id % kBack % 40) - 2, 0.03);
}

TEST_F(LoopStageTest, TheMapKeepsSomeViewsWithItsPoints) {
  PlaceParams params;
  params.interval_s = 0.5;
  params.keep_interval_s = 1;
  LoopStage stage(rig_, params);
  MapMaterial material;
  fly(stage, 0, material);
  LineMap map;
  map.pieces = {{}};
  map.points.resize(2);
  map.points[0].id = 200;
  map.points[1].id = 210;
  material.points[0].joined = {211};  // of a point that is not in the map
  for (PointRecord& point : material.points)
    if (point.id == 210) point.joined = {212};
  const std::vector<MapView> views = stage.takeViews(map, material);
  EXPECT_EQ(views.size(), 24u);
  std::set<std::int64_t> tracks;
  for (const MapView& view : views)
    for (const PlaceFeature& feature : view.looks.features) tracks.insert(feature.track);
  EXPECT_EQ(tracks, (std::set<std::int64_t>{PlaceFeature::kNoTrack, 200, 210}));
  EXPECT_TRUE(stage.takeViews(map, material).empty()) << "they are moved, not copied";

  params.keep_interval_s = 0;
  LoopStage none(rig_, params);
  MapMaterial again;
  fly(none, 0, again);
  EXPECT_TRUE(none.takeViews(map, again).empty());
}

TEST_F(LoopStageTest, SwitchedOffItLooksAtNothing) {
  PlaceParams params;
  params.enabled = false;
  LoopStage stage(rig_, params);
  MapMaterial material;
  const LoopResult loops = fly(stage, 0.2, material);
  EXPECT_FALSE(loops.searched);
  EXPECT_EQ(loops.places.described, 0u);
  EXPECT_TRUE(joinsOf(loops).empty());
}

TEST_F(LoopStageTest, AnAbsurdParameterIsRefusedByName) {
  PlaceParams params;
  params.max_error_px = -1;
  EXPECT_THROW(LoopStage(rig_, params), std::invalid_argument);
}

}  // namespace
}  // namespace lintel
