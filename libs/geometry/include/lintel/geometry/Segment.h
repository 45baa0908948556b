// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace lintel {

/// A finite 3D segment, ends in one frame [m].
struct Segment3 {
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::Zero();

  double length() const { return (end - start).norm(); }
  /// Unit direction start -> end; undefined for length 0.
  Eigen::Vector3d direction() const { return (end - start).normalized(); }
  Eigen::Vector3d midpoint() const { return 0.5 * (start + end); }
};

/// A finite segment in an image [px].
struct Segment2 {
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
};

/// How far two image segments are apart across `a`, on average, where they lie side by side [px]; negative when they
/// hardly do: on less than a fifth of the shorter one.
double separation(const Segment2& a, const Segment2& b);

/// Distance from `p` to the segment (not its infinite line) [m].
double distanceToSegment(const Eigen::Vector3d& p, const Segment3& segment);

/// Angle between two directions whose sign means nothing, in [0, pi/2] [rad]; exact near 0 (no acos).
double lineAngle(const Eigen::Vector3d& d0, const Eigen::Vector3d& d1);

}  // namespace lintel
