// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

namespace lintel {

/// A closed four-sided tube around a segment. Corners 0 to 3 stand around its start, 4 to 7 around its end: the mean of
/// either four is the end of the axis.
struct Tube {
  std::array<Eigen::Vector3d, 8> corners;
};

/// Triangles of any tube by corner, counter-clockwise seen from outside: 8 of the sides, 2 at either end.
extern const std::array<std::array<std::uint32_t, 3>, 12> kTubeTriangles;

/// The tube of `radius_m` (centre to corner). None when a triangle of it would have no area in single precision:
/// MeshLab ends on such a one.
std::optional<Tube> makeTube(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double radius_m);

/// A closed tetrahedron for a point: corners and triangles; none as above.
std::optional<std::array<Eigen::Vector3d, 4>> makeTetrahedron(const Eigen::Vector3d& centre, double radius_m);
extern const std::array<std::array<std::uint32_t, 3>, 4> kTetrahedronTriangles;

}  // namespace lintel
