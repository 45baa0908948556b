// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Segment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lintel {

double distanceToSegment(const Eigen::Vector3d& p, const Segment3& segment) {
  const Eigen::Vector3d d = segment.end - segment.start;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - segment.start).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - segment.start - t * d).norm();
}

double lineAngle(const Eigen::Vector3d& d0, const Eigen::Vector3d& d1) {
  return std::atan2(d0.cross(d1).norm(), std::abs(d0.dot(d1)));
}

}  // namespace lintel
