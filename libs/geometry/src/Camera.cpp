// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "FisheyeLens.h"

namespace lintel {
namespace {

constexpr double kFolding = 0.05;  ///< a smaller determinant: beyond the radius up to which the model is invertible

double awayFromZero(double z) { return std::abs(z) > 1e-9 ? z : 1e-9; }

/// Whether the image of a lens that is not wide grows in all directions where this is its derivative: not beyond a
/// fold, nor beyond a pole of the rational model, where the image comes back mirrored.
bool grows(const Eigen::Matrix2d& J) { return J.determinant() > kFolding && J(0, 0) > 0; }

constexpr int kFoldSteps = 8;  ///< places between the axis and a point that are looked at

/// Radial factor of a lens that is not wide, and its derivative by r^2.
struct Radial {
  double factor, derivative, divided_by = 1;

  Radial(const Camera& camera, double r2) {
    const auto& k = camera.lens;
    factor = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    derivative = k[0] + 2 * k[1] * r2 + 3 * k[4] * r2 * r2;
    if (camera.model != LensModel::kRational) return;
    divided_by = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
    factor /= divided_by;
    derivative = (derivative - factor * (k[5] + 2 * k[6] * r2 + 3 * k[7] * r2 * r2)) / divided_by;
  }
};

// Undistortion calls these a million times a minute, one after the other with the same radial factor.
[[gnu::always_inline]] inline Eigen::Vector2d distorted(const Camera& camera, const Eigen::Vector2d& n,
                                                        const Radial& radial) {
  const double x = n.x(), y = n.y(), r2 = x * x + y * y, p1 = camera.lens[2], p2 = camera.lens[3];
  return {x * radial.factor + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial.factor + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

[[gnu::always_inline]] inline Eigen::Matrix2d jacobianAt(const Camera& camera, const Eigen::Vector2d& n,
                                                         const Radial& radial) {
  const double x = n.x(), y = n.y(), p1 = camera.lens[2], p2 = camera.lens[3], dr = 2 * radial.derivative;
  Eigen::Matrix2d J;
  J(0, 0) = radial.factor + x * x * dr + 2 * p1 * y + 6 * p2 * x;
  J(0, 1) = x * y * dr + 2 * p1 * x + 2 * p2 * y;
  J(1, 0) = J(0, 1);
  J(1, 1) = radial.factor + y * y * dr + 6 * p1 * y + 2 * p2 * x;
  return J;
}

}  // namespace

Eigen::Vector2d Camera::distort(const Eigen::Vector2d& n) const {
  return distorted(*this, n, Radial(*this, n.squaredNorm()));
}

Eigen::Matrix2d Camera::distortJacobian(const Eigen::Vector2d& n) const {
  return jacobianAt(*this, n, Radial(*this, n.squaredNorm()));
}

Eigen::Matrix2d Camera::coefficientJacobian(const Eigen::Vector2d& n) const {
  const double r2 = n.squaredNorm();
  const Eigen::Vector2d scaled = model == LensModel::kRational ? Eigen::Vector2d(n / Radial(*this, r2).divided_by) : n;
  Eigen::Matrix2d J;
  J << scaled.x() * r2, scaled.x() * r2 * r2, scaled.y() * r2, scaled.y() * r2 * r2;
  return J;
}

Eigen::Vector2d Camera::undistort(const Eigen::Vector2d& wanted, const Eigen::Vector2d& near) const {
  Eigen::Vector2d n = near, invertible = Eigen::Vector2d::Zero();
  for (int i = 0; i < 40; ++i) {
    const Radial radial(*this, n.squaredNorm());
    const Eigen::Vector2d error = distorted(*this, n, radial) - wanted;
    const Eigen::Matrix2d J = jacobianAt(*this, n, radial);
    if (!grows(J)) {  // a step too far
      n = 0.5 * (n + invertible);
      continue;
    }
    invertible = n;
    n -= J.inverse() * error;
    if (error.squaredNorm() < 1e-16) break;  // the next one would be its square
  }
  return n;
}

Eigen::Vector2d Camera::toPixel(const Eigen::Vector2d& normalised) const {
  const Eigen::Vector2d d = distort(normalised);
  return {fx * d.x() + cx, fy * d.y() + cy};
}

Eigen::Vector2d Camera::normalise(const Eigen::Vector2d& px) const {
  return undistort({(px.x() - cx) / fx, (px.y() - cy) / fy});
}

Eigen::Vector2d Camera::normalise(const Eigen::Vector2d& px, const Eigen::Vector2d& near) const {
  return undistort({(px.x() - cx) / fx, (px.y() - cy) / fy}, near);
}

bool Camera::unproject(const Eigen::Vector2d& px, Eigen::Vector3d& ray) const {
  const Eigen::Vector2d position((px.x() - cx) / fx, (px.y() - cy) / fy);
  if (wide()) return fisheyeRay(*this, position, ray) && projects(ray);
  ray = undistort(position).homogeneous();
  return (distort(ray.head<2>()) - position).squaredNorm() < 1e-18 && projects(ray);
}

Eigen::Vector3d Camera::ray(const Eigen::Vector2d& px) const {
  if (!wide()) return normalise(px).homogeneous();
  Eigen::Vector3d found;
  unproject(px, found);
  return found;
}

Eigen::Vector2d Camera::project(const Eigen::Vector3d& p_c) const {
  if (!wide()) return toPixel(p_c.head<2>() / awayFromZero(p_c.z()));
  const Eigen::Vector2d d = fisheyePosition(*this, p_c);
  return {fx * d.x() + cx, fy * d.y() + cy};
}

bool Camera::projects(const Eigen::Vector3d& p_c) const {
  if (wide()) return fisheyeImage(*this, p_c).valid;
  if (p_c.z() <= 0) return false;
  const Eigen::Vector2d n = p_c.head<2>() / p_c.z();
  for (int i = kFoldSteps; i > 0; --i)  // a polynomial that has folded back may grow again farther out
    if (!grows(distortJacobian(n * i / kFoldSteps))) return false;
  return true;
}

Eigen::Vector2d Camera::project(const Eigen::Vector3d& p_c, double scale, PixelJacobians& scaled) const {
  const Eigen::Vector2d focal(scale * fx, scale * fy);
  if (wide()) {
    const LensImage image = fisheyeImage(*this, p_c);
    scaled.point = focal.asDiagonal() * image.by_point;
    scaled.intrinsics << scale * image.position.x(), 0, scale, 0, focal.x() * image.by_coefficients.row(0), 0,
        scale * image.position.y(), 0, scale, focal.y() * image.by_coefficients.row(1);
    return {fx * image.position.x() + cx, fy * image.position.y() + cy};
  }
  const double z = awayFromZero(p_c.z());
  const Eigen::Vector2d n = p_c.head<2>() / z;
  const Radial radial(*this, n.squaredNorm());
  const Eigen::Vector2d image = distorted(*this, n, radial);
  Eigen::Matrix<double, 2, 3> d_n;
  d_n << 1 / z, 0, -n.x() / z, 0, 1 / z, -n.y() / z;
  const Eigen::Matrix2d d_distorted = focal.asDiagonal() * jacobianAt(*this, n, radial);
  scaled.point = d_distorted * d_n;
  const double r2 = n.squaredNorm(), share = 1 / radial.divided_by;
  const double x = focal.x() * n.x() * share, y = focal.y() * n.y() * share;
  scaled.intrinsics << scale * image.x(), 0, scale, 0, x * r2, x * r2 * r2, 0, scale * image.y(), 0, scale, y * r2,
      y * r2 * r2;
  return {fx * image.x() + cx, fy * image.y() + cy};
}

double largestAngle(const Camera& camera) {
  double largest = 0;
  const double right = camera.width - 1.0, bottom = camera.height - 1.0;
  for (const double x : {0.0, camera.cx, right})
    for (const double y : {0.0, camera.cy, bottom}) {
      const Eigen::Vector3d ray = camera.ray({x, y});
      largest = std::max(largest, std::atan2(ray.head<2>().norm(), ray.z()));
    }
  return largest;
}

}  // namespace lintel
