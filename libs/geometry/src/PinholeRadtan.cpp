// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/PinholeRadtan.h"

#include <Eigen/LU>

namespace lintel {

Eigen::Vector2d PinholeRadtan::distort(const Eigen::Vector2d& n) const {
  const double x = n.x(), y = n.y(), r2 = x * x + y * y, radial = 1 + r2 * (k1 + r2 * k2);
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Matrix2d PinholeRadtan::distortJacobian(const Eigen::Vector2d& n) const {
  const double x = n.x(), y = n.y(), r2 = x * x + y * y, radial = 1 + r2 * (k1 + r2 * k2), dr = 2 * k1 + 4 * k2 * r2;
  Eigen::Matrix2d J;
  J(0, 0) = radial + x * x * dr + 2 * p1 * y + 6 * p2 * x;
  J(0, 1) = x * y * dr + 2 * p1 * x + 2 * p2 * y;
  J(1, 0) = J(0, 1);
  J(1, 1) = radial + y * y * dr + 6 * p1 * y + 2 * p2 * x;
  return J;
}

Eigen::Vector2d PinholeRadtan::undistort(const Eigen::Vector2d& distorted) const {
  Eigen::Vector2d n = distorted;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d error = distort(n) - distorted;
    if (error.squaredNorm() < 1e-24) break;
    const Eigen::Matrix2d J = distortJacobian(n);
    if (J.determinant() < 0.05) break;  // beyond the radius up to which the model is invertible
    n -= J.inverse() * error;
  }
  return n;
}

Eigen::Vector2d PinholeRadtan::toPixel(const Eigen::Vector2d& normalised) const {
  const Eigen::Vector2d d = distort(normalised);
  return {fx * d.x() + cx, fy * d.y() + cy};
}

Eigen::Vector2d PinholeRadtan::project(const Eigen::Vector3d& p_c) const { return toPixel(p_c.head<2>() / p_c.z()); }

Eigen::Vector2d PinholeRadtan::normalise(const Eigen::Vector2d& px) const {
  return undistort({(px.x() - cx) / fx, (px.y() - cy) / fy});
}

}  // namespace lintel
