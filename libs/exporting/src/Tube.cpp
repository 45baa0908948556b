// SPDX-License-Identifier: BSD-3-Clause
#include "Tube.h"

#include <Eigen/Geometry>

#include "lintel/geometry/Rotation.h"

namespace lintel {

const std::array<std::array<std::uint32_t, 3>, 12> kTubeTriangles{{{0, 1, 5},
                                                                   {0, 5, 4},
                                                                   {1, 2, 6},
                                                                   {1, 6, 5},
                                                                   {2, 3, 7},
                                                                   {2, 7, 6},
                                                                   {3, 0, 4},
                                                                   {3, 4, 7},
                                                                   {0, 3, 2},
                                                                   {0, 2, 1},
                                                                   {4, 5, 6},
                                                                   {4, 6, 7}}};

const std::array<std::array<std::uint32_t, 3>, 4> kTetrahedronTriangles{{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};

namespace {

template <class Corners, class Triangles>
bool everyTriangleHasArea(const Corners& corners, const Triangles& triangles) {
  for (const auto& triangle : triangles) {
    const Eigen::Vector3f a = corners[triangle[0]].template cast<float>(),
                          b = corners[triangle[1]].template cast<float>(),
                          c = corners[triangle[2]].template cast<float>();
    if (!((b - a).cross(c - a).squaredNorm() > 0)) return false;
  }
  return true;
}

}  // namespace

std::optional<Tube> makeTube(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double radius_m) {
  const Eigen::Vector3d along = end - start;
  if (!(along.squaredNorm() > 0)) return std::nullopt;
  const Eigen::Matrix<double, 3, 2> across = radius_m * tangentBasis(along);
  Tube tube;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d offset = (i < 2 ? 1 : -1) * across.col(static_cast<Eigen::Index>(i % 2));
    tube.corners[i] = start + offset;
    tube.corners[i + 4] = end + offset;
  }
  if (!everyTriangleHasArea(tube.corners, kTubeTriangles)) return std::nullopt;
  return tube;
}

std::optional<std::array<Eigen::Vector3d, 4>> makeTetrahedron(const Eigen::Vector3d& centre, double radius_m) {
  const double r = radius_m / std::sqrt(3.0);
  std::array<Eigen::Vector3d, 4> corners{
      {centre + r * Eigen::Vector3d(1, 1, 1), centre + r * Eigen::Vector3d(-1, -1, 1),
       centre + r * Eigen::Vector3d(1, -1, -1), centre + r * Eigen::Vector3d(-1, 1, -1)}};
  if (!everyTriangleHasArea(corners, kTetrahedronTriangles)) return std::nullopt;
  return corners;
}

}  // namespace lintel
