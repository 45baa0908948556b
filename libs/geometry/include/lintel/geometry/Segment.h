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

/// Distance from `p` to the segment (not its infinite line) [m].
double distanceToSegment(const Eigen::Vector3d& p, const Segment3& segment);

/// Angle between two directions whose sign means nothing, in [0, pi/2] [rad]; exact near 0 (no acos).
double lineAngle(const Eigen::Vector3d& d0, const Eigen::Vector3d& d1);

}  // namespace lintel
