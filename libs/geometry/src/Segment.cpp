// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Segment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace lintel {

double distanceToSegment(const Eigen::Vector3d& p, const Segment3& segment) {
  const Eigen::Vector3d d = segment.end - segment.start;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - segment.start).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - segment.start - t * d).norm();
}

double separation(const Segment2& a, const Segment2& b) {
  const Eigen::Vector2d along = a.end - a.start;
  const double length = along.norm();
  if (length < 1) return -1;
  const Eigen::Vector2d d = along / length, n(-d.y(), d.x());
  double u0 = (b.start - a.start).dot(d), u1 = (b.end - a.start).dot(d);
  double v0 = (b.start - a.start).dot(n), v1 = (b.end - a.start).dot(n);
  if (u0 > u1) std::swap(u0, u1), std::swap(v0, v1);
  const double from = std::max(0.0, u0), to = std::min(length, u1);
  if (to - from < 0.2 * std::min(length, u1 - u0) || u1 - u0 < 1) return -1;
  const auto across = [&](double u) { return v0 + (v1 - v0) * (u - u0) / (u1 - u0); };
  return 0.5 * std::abs(across(from) + across(to));
}

double lineAngle(const Eigen::Vector3d& d0, const Eigen::Vector3d& d1) {
  return std::atan2(d0.cross(d1).norm(), std::abs(d0.dot(d1)));
}

}  // namespace lintel
