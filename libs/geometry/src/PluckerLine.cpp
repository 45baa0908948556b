// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/PluckerLine.h"

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {

PluckerLine lineThrough(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1) {
  const Eigen::Vector3d d = (p1 - p0).normalized();
  return {p0.cross(d), d};
}

PluckerLine movedOrigin(const PluckerLine& line, const Eigen::Vector3d& o_a) {
  return {line.n - o_a.cross(line.d), line.d};
}

PluckerLine OrthonormalLine::plucker() const {
  const Eigen::Matrix3d R = U.toRotationMatrix();
  return {std::cos(phi) * R.col(0), std::sin(phi) * R.col(1)};
}

OrthonormalLine toOrthonormal(const PluckerLine& line) {
  const double n_norm = line.n.norm(), d_norm = line.d.norm();
  Eigen::Matrix3d R;
  R.col(1) = line.d / d_norm;
  R.col(0) = n_norm > 1e-12 * d_norm ? Eigen::Vector3d(line.n / n_norm) : Eigen::Vector3d(tangentBasis(line.d).col(0));
  // rounding may have left n·d slightly off zero: the direction is kept, the moment projected
  R.col(0) = (R.col(0) - R.col(0).dot(R.col(1)) * R.col(1)).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  return {Eigen::Quaterniond(R).normalized(), std::atan2(d_norm, n_norm)};
}

bool closestPointToRay(const PluckerLine& line_c, const Eigen::Vector3d& ray_c, Eigen::Vector3d& p_c) {
  const Eigen::Vector3d ray = ray_c.normalized(), d = line_c.d.normalized();
  const Eigen::Vector3d p0 = line_c.nearestPoint();
  const double cosine = ray.dot(d), denominator = 1 - cosine * cosine;
  if (denominator < 1e-18) return false;
  // minimise |p0 + s d - t ray| over s and t
  const double s = (cosine * ray.dot(p0) - d.dot(p0)) / denominator;
  p_c = p0 + s * d;
  return true;
}

}  // namespace lintel
