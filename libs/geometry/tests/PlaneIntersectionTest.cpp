// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/PlaneIntersection.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace lintel {
namespace {

const Eigen::Vector3d kPoint(1, 2, 5), kDirection = Eigen::Vector3d(1, -0.3, 0.2).normalized();

/// The planes in which cameras in these places see the line.
std::vector<ObservationPlane> planesFrom(const std::vector<Eigen::Vector3d>& centres) {
  std::vector<ObservationPlane> planes;
  planes.reserve(centres.size());
  for (const Eigen::Vector3d& c : centres) planes.push_back({(kPoint - c).cross(kDirection).normalized(), c});
  return planes;
}

double distanceToTrueLine(const Eigen::Vector3d& p) { return (p - kPoint).cross(kDirection).norm(); }

TEST(PlaneIntersection, FindsTheLineOfManyPlanesAbreastOfTheAnchor) {
  const Eigen::Vector3d anchor(3, 0, 1);
  const auto line = intersectPlanes(planesFrom({{0, 0, 0}, {0, 1, 0}, {0.3, 0.2, 1}}), anchor);
  ASSERT_TRUE(line);
  EXPECT_LT(line->direction_w.cross(kDirection).norm(), 1e-9);
  EXPECT_LT(distanceToTrueLine(line->point_w), 1e-9);
  EXPECT_NEAR((line->point_w - anchor).dot(kDirection), 0, 1e-9);
}

TEST(PlaneIntersection, PlanesThatCoincideSayNothing) {
  EXPECT_FALSE(intersectPlanes(planesFrom({{0, 0, 0}, kDirection, -2 * kDirection}), {0, 0, 0}));
}

TEST(PlaneIntersection, ADirectionAndAPointMakeUpForPlanesThatCoincide) {
  const auto line = intersectPlanes(planesFrom({{0, 0, 0}, kDirection}), {0, 0, 0}, {kDirection, {kPoint}});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->direction_w, kDirection);
  EXPECT_LT(distanceToTrueLine(line->point_w), 1e-9);
}

}  // namespace
}  // namespace lintel
