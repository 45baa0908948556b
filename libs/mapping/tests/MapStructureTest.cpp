// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapStructure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lintel {
namespace {

using Eigen::Vector3d;

constexpr double kSigma_m = 0.004, kSigma_rad = 0.002;

void addLine(LineMap& map, const Vector3d& start, const Vector3d& end) {
  MapLine line;
  line.id = map.lines.empty() ? 10 : map.lines.back().id + 3;
  line.segment_w = {start, end};
  line.covariance.diagonal() << kSigma_m * kSigma_m, kSigma_m * kSigma_m, kSigma_rad * kSigma_rad,
      kSigma_rad * kSigma_rad;
  map.lines.push_back(line);
}

/// The twelve edges, of which five centimetres at either end are missing.
void addBox(LineMap& map, const Vector3d& low, const Vector3d& high) {
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner) {
      Vector3d a = low, b = low;
      a[(axis + 1) % 3] = b[(axis + 1) % 3] = corner % 2 == 0 ? low[(axis + 1) % 3] : high[(axis + 1) % 3];
      a[(axis + 2) % 3] = b[(axis + 2) % 3] = corner / 2 == 0 ? low[(axis + 2) % 3] : high[(axis + 2) % 3];
      b[axis] = high[axis];
      const Vector3d missing = 0.05 * (b - a).normalized();
      addLine(map, a + missing, b - missing);
    }
}

void addCamera(LineMap& map, const Vector3d& p_w) {
  MapKeyframe keyframe;
  keyframe.T_w_b.p = p_w;
  map.keyframes.push_back(keyframe);
}

std::vector<std::string> namesOf(const LineMap& map) {
  std::vector<std::string> names;
  for (const MapPlane& plane : map.planes) names.push_back(plane.name);
  std::sort(names.begin(), names.end());
  return names;
}

TEST(MapStructure, ACubeHasEightCornersAndSixPlanes) {
  LineMap map;
  addBox(map, {0, 0, 0}, {1, 1, 1});
  findStructure(map);
  ASSERT_EQ(map.corners.size(), 8u);
  for (const MapCorner& corner : map.corners) {
    EXPECT_EQ(corner.lines.size(), 3u);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(corner.p_w[i], std::round(corner.p_w[i]), 1e-9);
    EXPECT_GT(corner.sigma_m, 0.5 * kSigma_m);
    EXPECT_LT(corner.sigma_m, 2 * kSigma_m);
  }
  ASSERT_EQ(map.planes.size(), 6u);
  for (const MapPlane& plane : map.planes) {
    EXPECT_EQ(plane.lines.size(), 4u);
    EXPECT_NEAR(plane.normal_w.cwiseAbs().maxCoeff(), 1, 1e-9);
    EXPECT_LT(plane.spread_m, 1e-9);
  }
  EXPECT_EQ(namesOf(map), (std::vector<std::string>{"horizontal 1", "horizontal 2", "vertical 1", "vertical 2",
                                                    "vertical 3", "vertical 4"}));
}

TEST(MapStructure, WhatIsLargeAndHasNothingBehindIsFloorCeilingAndWalls) {
  LineMap map;
  addBox(map, {0, 0, 0}, {5, 4, 3});
  addBox(map, {2, 2, 0.3}, {2.5, 2.5, 0.8});
  addCamera(map, {1, 1, 1.5});
  findStructure(map);
  const std::vector<std::string> names = namesOf(map);
  for (const char* name : {"floor", "ceiling", "wall 1", "wall 2", "wall 3", "wall 4", "horizontal 1", "vertical 4"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  for (const MapPlane& plane : map.planes)
    EXPECT_GT(plane.normal_w.dot(map.keyframes.front().T_w_b.p), plane.offset_m) << plane.name;
}

/// What is seen, and how well, from as much farther away.
void enlarge(double times, LineMap& map) {
  const Eigen::Vector4f scale(static_cast<float>(times), static_cast<float>(times), 1, 1);
  for (MapLine& line : map.lines) {
    line.segment_w = {times * line.segment_w.start, times * line.segment_w.end};
    line.covariance = scale.asDiagonal() * line.covariance * scale.asDiagonal();
  }
  for (MapPoint& point : map.points) point.p_w *= times, point.sigma_distance_m *= times;
  for (MapKeyframe& keyframe : map.keyframes) keyframe.T_w_b.p *= times;
}

TEST(MapStructure, LargeAndSmallPlacesHaveWhatAHallHas) {
  LineMap hall;
  addBox(hall, {0, 0, 0}, {15, 12, 9});
  addCamera(hall, {3, 3, 4.5});
  for (MapLine& line : hall.lines) {
    line.observations.emplace_back();  // of keyframe 0
    line.covariance *= 0.1F;
  }
  hall.points.emplace_back();
  hall.points.back().p_w = {8, 0.2, 0.003};
  findStructure(hall);
  ASSERT_EQ(hall.corners.size(), 8u);
  for (const double times : {20.0, 0.04}) {
    LineMap map = hall;
    enlarge(times, map);
    findStructure(map);
    ASSERT_EQ(map.corners.size(), hall.corners.size()) << times;
    for (std::size_t i = 0; i < map.corners.size(); ++i) {
      EXPECT_LT((map.corners[i].p_w - times * hall.corners[i].p_w).norm(), 1e-6 * times);
      EXPECT_EQ(map.corners[i].lines, hall.corners[i].lines);
      EXPECT_LT(map.corners[i].sigma_m, 2.5 * times * hall.corners[i].sigma_m);
    }
    EXPECT_EQ(namesOf(map), namesOf(hall));
    for (const MapPlane& plane : map.planes) {
      if (plane.name == "ceiling") EXPECT_NEAR(std::abs(plane.offset_m), 9 * times, 1e-6 * times);
      EXPECT_EQ(plane.points.size(), plane.name == "floor" ? 1u : 0u) << plane.name;
    }
  }
}

TEST(MapStructure, PiecesOfAWallAreOnePlane) {
  LineMap map;
  addCamera(map, {1, 1, 1});
  const auto addFrame = [&](double x) {  // on the wall y = 3
    const Vector3d corners[] = {{x, 3, 0}, {x + 2.5, 3, 0}, {x + 2.5, 3, 2}, {x, 3, 2}};
    for (int i = 0; i < 4; ++i) addLine(map, corners[i], corners[(i + 1) % 4]);
  };
  addFrame(0);
  addFrame(4);  // too far away to be connected
  findStructure(map);
  ASSERT_EQ(map.planes.size(), 1u);
  EXPECT_EQ(map.planes[0].name, "wall 1");
  EXPECT_EQ(map.planes[0].lines.size(), 8u);
}

TEST(MapStructure, LinesThatPassEachOtherDoNotMeet) {
  const auto corners = [](double sigmas) {
    LineMap map;
    const double gap_m = sigmas * std::hypot(std::sqrt(2.0) * kSigma_m, std::sqrt(2.0) * 0.002);  // with the floor
    addLine(map, {0, 0, 0}, {1, 0, 0});
    addLine(map, {1, 0, gap_m}, {1, 1, gap_m});
    findStructure(map);
    return map.corners.size();
  };
  EXPECT_EQ(corners(1), 1u);
  EXPECT_EQ(corners(3), 0u);
}

TEST(MapStructure, LinesThatGoOnDoNotMakeACorner) {
  LineMap map;
  addLine(map, {-1, 0, 0}, {1, 0, 0});
  addLine(map, {0, -1, 0}, {0, 1, 0});
  findStructure(map);
  EXPECT_TRUE(map.corners.empty());
  EXPECT_TRUE(map.planes.empty());  // two lines are not enough
}

TEST(MapStructure, RandomLinesHaveNone) {
  LineMap map;
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const auto place = [&](double size_m) {
    return Vector3d(size_m * uniform(), size_m * uniform(), size_m * uniform());
  };
  for (int i = 0; i < 300; ++i) {
    const Vector3d start = place(8);
    addLine(map, start, start + place(1.5) - Vector3d::Constant(0.75));
  }
  findStructure(map);
  EXPECT_TRUE(map.corners.empty());
  EXPECT_TRUE(map.planes.empty());
}

TEST(MapStructure, PlanesHaveThePointsNearTheirLines) {
  LineMap map;
  addBox(map, {0, 0, 0}, {1, 1, 1});
  const Vector3d places[] = {{0.5, 0.5, 0.001}, {0.5, 0.5, 0.05}, {0.5, 5, 0}};  // in the lowest plane, off, too far
  for (const Vector3d& p_w : places) {
    MapPoint point;
    point.id = map.points.size() + 1;
    point.p_w = p_w, point.sigma_distance_m = 0.005;
    map.points.push_back(point);
  }
  findStructure(map);
  for (const MapPlane& plane : map.planes) {
    const bool lowest = std::abs(plane.offset_m) < 1e-6 && std::abs(plane.normal_w.z()) > 0.9;
    EXPECT_EQ(plane.points, lowest ? std::vector<std::uint64_t>{1} : std::vector<std::uint64_t>{});
  }
}

TEST(MapStructure, LinesWithoutACovarianceGoByTheirSigmas) {
  LineMap map;
  addBox(map, {0, 0, 0}, {1, 1, 1});
  for (MapLine& line : map.lines) {
    line.covariance.setZero();
    line.sigma_distance_m = kSigma_m, line.sigma_direction_rad = kSigma_rad;
  }
  findStructure(map);
  EXPECT_EQ(map.corners.size(), 8u);
  EXPECT_EQ(map.planes.size(), 6u);
}

}  // namespace
}  // namespace lintel
