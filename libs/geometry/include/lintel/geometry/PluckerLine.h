// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "lintel/geometry/Segment.h"

namespace lintel {

/// An infinite 3D line in Plücker coordinates: direction `d`, moment `n` = p x d for any point p on the line, relative
/// to the origin of the frame it is given in. Homogeneous: (n, d) and s (n, d) are the same line. n·d = 0.
/// The distance to the origin is ‖n‖ / ‖d‖ ([Lim2021] prints the inverse).
struct PluckerLine {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  Eigen::Vector3d d = Eigen::Vector3d::UnitX();

  double distance() const { return n.norm() / d.norm(); }
  /// The point of the line nearest to the origin.
  Eigen::Vector3d nearestPoint() const { return d.cross(n) / d.squaredNorm(); }
};

/// The line through two points.
PluckerLine lineThrough(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1);

/// The same line about another reference point: `o_a` is the new origin, given in the old frame (axes stay).
PluckerLine movedOrigin(const PluckerLine& line, const Eigen::Vector3d& o_a);

/// Orthonormal representation [Bartoli2005], 4 DoF: n = cos(phi) u1, d = sin(phi) u2 with u1, u2 the first columns of
/// the rotation U. Up to the scale of (n, d). phi in (0, pi/2); phi -> pi/2 when the line meets the origin.
struct OrthonormalLine {
  Eigen::Quaterniond U = Eigen::Quaterniond::Identity();
  double phi = 0;

  PluckerLine plucker() const;
};

/// From Plücker coordinates; a line through the origin gets a deterministic u1 perpendicular to its direction.
OrthonormalLine toOrthonormal(const PluckerLine& line);

/// The point of a line (camera frame) that the ray `normalised` (x, y, 1) comes nearest to.
/// Returns false when line and ray are parallel to within 1e-9.
bool closestPointToRay(const PluckerLine& line_c, const Eigen::Vector3d& ray_c, Eigen::Vector3d& p_c);

}  // namespace lintel
