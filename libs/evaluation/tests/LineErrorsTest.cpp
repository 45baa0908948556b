// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/LineErrors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using Eigen::Vector3d;

MapLine mapLine(const Vector3d& start, const Vector3d& end, bool degenerate = false) {
  MapLine line;
  line.segment_w = {start, end};
  line.degenerate = degenerate;
  return line;
}

TrueLine edge(const Vector3d& start, const Vector3d& end, int frames_seen = 100) { return {{start, end}, frames_seen}; }

// Two edges of 2 m that are far apart, one along x and one along z.
const std::vector<TrueLine> kEdges = {edge({0, 0, 0}, {2, 0, 0}), edge({10, 0, 0}, {10, 0, 2})};

TEST(LineErrors, AMapThatIsTheTruth) {
  const LineErrors e = evaluateLines({mapLine({0, 0, 0}, {2, 0, 0}), mapLine({10, 0, 2}, {10, 0, 0})}, {}, kEdges);
  EXPECT_EQ(e.lines, 2u);
  EXPECT_DOUBLE_EQ(e.length_m, 4);
  EXPECT_DOUBLE_EQ(e.observable_m, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(e.precision[i], 1, 1e-12);
    EXPECT_NEAR(e.recall[i], 1, 1e-12);
  }
  EXPECT_NEAR(e.duplicates, 1, 1e-12);
  EXPECT_EQ(e.all_matched.count, 2u);
  EXPECT_NEAR(e.all_matched.direction_median_rad, 0, 1e-12);
  EXPECT_EQ(e.degenerate_matched.count, 0u);
  EXPECT_TRUE(std::isnan(e.degenerate_matched.direction_median_rad));
}

TEST(LineErrors, ShiftedAndShortByHand) {
  // One segment of 1 m, 3.5 cm beside the first edge: right at 5 and 10 cm, but not at 2 cm.
  const LineErrors e = evaluateLines({mapLine({0.5, 0.035, 0}, {1.5, 0.035, 0})}, {}, kEdges);
  EXPECT_EQ(e.precision[0], 0);
  EXPECT_NEAR(e.precision[1], 1, 1e-12);
  EXPECT_EQ(e.recall[0], 0);
  // Pieces of the edge 2 cm long, middles at 1, 3, 5 … cm: within 5 cm of the segment are those from 47 cm (3 cm
  // beyond its end, 3.5 cm beside it) to 153 cm: 54 pieces, 108 cm of 400 cm.
  EXPECT_NEAR(e.recall[1], 1.08 / 4, 1e-12);
  EXPECT_NEAR(e.all_matched.distance_median_m, 0.035, 1e-12);
}

TEST(LineErrors, TurnedSegments) {
  const auto turned = [](double degrees) {  // about the middle of the first edge, 20 cm long
    const double a = degrees * M_PI / 180;
    const Vector3d half(0.1 * std::cos(a), 0.1 * std::sin(a), 0);
    return evaluateLines({mapLine(Vector3d(1, 0, 0) - half, Vector3d(1, 0, 0) + half)}, {}, kEdges);
  };
  EXPECT_NEAR(turned(10).all_matched.direction_median_rad, 10 * M_PI / 180, 1e-12);
  EXPECT_NEAR(turned(10).precision[2], 1, 1e-12);
  EXPECT_EQ(turned(20).precision[2], 0);  // too much to be right, but matched
  EXPECT_EQ(turned(20).all_matched.count, 1u);
  EXPECT_EQ(turned(40).all_matched.count, 0u);
}

TEST(LineErrors, DegenerateOnesApart) {
  const double a = 0.1;
  const LineErrors e = evaluateLines(
      {mapLine({0, 0, 0}, {2, 0, 0}), mapLine({10, 0, 1}, {10, 0.5 * std::sin(a), 1 + 0.5 * std::cos(a)}, true)}, {},
      kEdges);
  EXPECT_EQ(e.degenerate, 1u);
  EXPECT_EQ(e.degenerate_matched.count, 1u);
  EXPECT_NEAR(e.degenerate_matched.direction_median_rad, a, 1e-12);
  EXPECT_EQ(e.well_determined_matched.count, 1u);
  EXPECT_NEAR(e.well_determined_matched.direction_median_rad, 0, 1e-12);
  EXPECT_NEAR(e.all_matched.direction_p90_rad, a, 1e-12);
}

TEST(LineErrors, DuplicatesByHand) {
  // 0 … 1 m and 0.5 … 1.5 m of an edge: 2 m of map on 1.5 m of edge.
  const LineErrors e = evaluateLines({mapLine({0, 0, 0}, {1, 0, 0}), mapLine({0.5, 0, 0}, {1.5, 0, 0})}, {}, kEdges);
  EXPECT_NEAR(e.duplicates, 2.0 / 1.5, 1e-12);
}

TEST(LineErrors, LinesThatImagesShowApartAreNoDuplicates) {
  // All three on one metre of an edge: the second 10 px beside the first in one image, the third 1 px.
  std::vector<MapLine> map(3, mapLine({0, 0, 0}, {1, 0, 0}));
  const auto seenAt = [](std::uint64_t keyframe, double y) { return MapLineObservation{keyframe, {100, y}, {200, y}}; };
  map[0].observations = {seenAt(1, 50), seenAt(3, 50)};
  map[1].observations = {seenAt(2, 50), seenAt(3, 60)};
  map[2].observations = {seenAt(3, 51)};
  LineErrors e = evaluateLines(map, {}, kEdges);
  EXPECT_NEAR(e.duplicates, 3, 1e-12);
  EXPECT_NEAR(e.true_duplicates, 2, 1e-12);
  map[2].observations = {seenAt(4, 51)};  // never in one image with the others: nothing says that it is another line
  EXPECT_NEAR(evaluateLines(map, {}, kEdges).true_duplicates, 2, 1e-12);
  map[2].observations = {seenAt(3, 90)};
  EXPECT_NEAR(evaluateLines(map, {}, kEdges).true_duplicates, 1, 1e-12);
}

TEST(LineErrors, ShortAndRarelySeenEdgesDoNotCountForRecall) {
  const std::vector<TrueLine> truth = {edge({0, 0, 0}, {2, 0, 0}), edge({5, 0, 0}, {5.4, 0, 0}),
                                       edge({8, 0, 0}, {9, 0, 0}, 59)};
  EXPECT_DOUBLE_EQ(evaluateLines({mapLine({0, 0, 0}, {2, 0, 0})}, {}, truth).observable_m, 2);
}

TEST(LineErrors, MovesTheMapFirst) {
  Similarity S;
  S.T_a_b = {expRotation({0, 0, M_PI / 2}), {2, 0, 0}};
  S.scale = 2;
  const LineErrors e = evaluateLines({mapLine({0, 0, 0}, {0, 1, 0})}, S, kEdges);  // onto (2,0,0) … (0,0,0)
  EXPECT_NEAR(e.precision[0], 1, 1e-12);
  EXPECT_DOUBLE_EQ(e.length_m, 2);
}

TEST(LineErrors, SurfacesByHand) {
  // The floor is true. One metre lies on it, one metre climbs from it by 4 cm: half of that within 2 cm.
  const auto floor = [](const Vector3d& p) { return std::abs(p.z()); };
  const double along = std::sqrt(1 - 0.04 * 0.04);
  const std::vector<MapLine> map{mapLine({0, 5, 0}, {1, 5, 0}), mapLine({0, 6, 0}, {along, 6, 0.04})};
  const LineErrors e = evaluateLines(map, {}, kEdges, {}, floor);
  ASSERT_EQ(e.surface_precision.size(), 3u);
  EXPECT_NEAR(e.surface_precision[0], 0.75, 1e-9);
  EXPECT_NEAR(e.surface_precision[1], 1, 1e-9);
  EXPECT_TRUE(evaluateLines(map, {}, kEdges).surface_precision.empty());
  EXPECT_NEAR(e.surface_length_m[0], 1.5, 1e-9);
  EXPECT_NEAR(e.surface_length_m[1], 2, 1e-9);
}

TEST(LineErrors, LinesThatTouchASurfaceCountWhole) {
  const auto floor = [](const Vector3d& p) { return std::abs(p.z()); };
  const LineErrors e =
      evaluateLines({mapLine({0, 0, 0}, {0, 0, 1}), mapLine({0, 0, 0.5}, {0, 0, 1})}, {}, kEdges, {}, floor);
  EXPECT_DOUBLE_EQ(e.surface_lines[0], 0.5);
}

TEST(LineErrors, OfAnEmptyMap) {
  const LineErrors e = evaluateLines({}, {}, kEdges);
  EXPECT_TRUE(std::isnan(e.precision[0]));
  EXPECT_EQ(e.recall[2], 0);
  EXPECT_TRUE(std::isnan(e.duplicates));
}

}  // namespace
}  // namespace lintel
