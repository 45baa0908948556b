// SPDX-License-Identifier: BSD-3-Clause
#include "FisheyeLens.h"

#include <algorithm>
#include <cmath>

namespace lintel {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kFlat = 0.05;  ///< a smaller derivative of the radius: beyond that angle a model is not invertible

/// [Kannala2006]: radius = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8), theta the angle to the axis.
struct RadiusOfAngle {
  double radius, derivative;

  RadiusOfAngle(const Camera& camera, double theta) {
    const auto& k = camera.lens;
    const double t2 = theta * theta;
    radius = theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
    derivative = 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
  }
};

/// Where the direction of (x, y) is not defined.
bool onAxis(double r2, double size2) { return r2 < 1e-16 * size2; }

double inverseDepth(const Eigen::Vector3d& p) { return 1 / (std::abs(p.z()) > 1e-12 ? p.z() : 1e-12); }

LensImage equidistantImage(const Camera& camera, const Eigen::Vector3d& p) {
  const double r = p.head<2>().norm(), size2 = p.squaredNorm(), theta = std::atan2(r, p.z());
  const RadiusOfAngle image(camera, theta);
  LensImage out;
  out.valid = image.derivative > kFlat;
  if (onAxis(r * r, size2)) {
    const double scale = inverseDepth(p);
    out.position = p.head<2>() * scale;
    out.by_point << scale, 0, -p.x() * scale * scale, 0, scale, -p.y() * scale * scale;
    out.by_coefficients.setZero();
    out.valid = out.valid && p.z() > 0;
    return out;
  }
  const Eigen::Vector2d e = p.head<2>() / r;
  out.position = image.radius * e;
  const Eigen::RowVector3d d_theta(p.z() * e.x() / size2, p.z() * e.y() / size2, -r / size2);
  out.by_point = e * (image.derivative * d_theta);
  const double around = image.radius / r;  // (x, y) turns about the axis
  out.by_point(0, 0) += around * e.y() * e.y();
  out.by_point(0, 1) -= around * e.x() * e.y();
  out.by_point(1, 0) -= around * e.x() * e.y();
  out.by_point(1, 1) += around * e.x() * e.x();
  const double t3 = theta * theta * theta;
  out.by_coefficients << e * t3, e * (t3 * theta * theta);
  return out;
}

bool equidistantRay(const Camera& camera, const Eigen::Vector2d& position, Eigen::Vector3d& ray) {
  const double wanted = position.norm();
  ray = Eigen::Vector3d::UnitZ();
  if (wanted < 1e-12) return true;
  double theta = std::min(wanted, 0.5 * kPi), invertible = 0, error = 1;
  for (int i = 0; i < 40; ++i) {
    const RadiusOfAngle image(camera, theta);
    error = image.radius - wanted;
    if (image.derivative <= kFlat) {  // a step too far
      theta = 0.5 * (theta + invertible);
      continue;
    }
    if (std::abs(error) < 1e-14) break;
    invertible = theta;
    theta = std::clamp(theta - error / image.derivative, 0.0, kPi);
  }
  ray << position * (std::sin(theta) / wanted), std::cos(theta);
  return std::abs(error) < 1e-9;
}

/// Double sphere and extended unified model: position = (x, y) / denominator(p).
struct Denominator {
  double value;
  Eigen::RowVector3d by_point;
  Eigen::RowVector2d by_coefficients;
  bool valid;
};

/// How far back a sphere's model holds, as -z over the distance.
double farthestBack(double alpha) { return alpha <= 0.5 ? alpha / (1 - alpha) : (1 - alpha) / alpha; }

/// [Usenko2018] (38) to (45).
Denominator doubleSphere(const Camera& camera, const Eigen::Vector3d& p) {
  const double xi = camera.lens[0], alpha = camera.lens[1], d1 = p.norm(), k = xi * d1 + p.z();
  const double d2 = std::sqrt(p.head<2>().squaredNorm() + k * k), w1 = farthestBack(alpha);
  const double w2 = (w1 + xi) / std::sqrt(2 * w1 * xi + xi * xi + 1);
  const Eigen::RowVector3d d_d1 = p.transpose() / d1, d_k = xi * d_d1 + Eigen::RowVector3d::UnitZ();
  const Eigen::RowVector3d d_d2 = (Eigen::RowVector3d(p.x(), p.y(), 0) + k * d_k) / d2;
  return {alpha * d2 + (1 - alpha) * k, alpha * d_d2 + (1 - alpha) * d_k,
          Eigen::RowVector2d(alpha * k * d1 / d2 + (1 - alpha) * d1, d2 - k), p.z() > -w2 * d1};
}

/// [Khomutenko2016].
Denominator extendedUnified(const Camera& camera, const Eigen::Vector3d& p) {
  const double alpha = camera.lens[0], beta = camera.lens[1], r2 = p.head<2>().squaredNorm();
  const double d = std::sqrt(beta * r2 + p.z() * p.z());
  const Eigen::RowVector3d d_d = Eigen::RowVector3d(beta * p.x(), beta * p.y(), p.z()) / d;
  return {alpha * d + (1 - alpha) * p.z(), alpha * d_d + (1 - alpha) * Eigen::RowVector3d::UnitZ(),
          Eigen::RowVector2d(d - p.z(), 0.5 * alpha * r2 / d), p.z() > -farthestBack(alpha) * d};
}

LensImage sphereImage(const Denominator& d, const Eigen::Vector3d& p) {
  LensImage out;
  const double inverse = 1 / (std::abs(d.value) > 1e-12 ? d.value : 1e-12);
  out.position = p.head<2>() * inverse;
  out.by_point = -inverse * out.position * d.by_point;
  out.by_point(0, 0) += inverse;
  out.by_point(1, 1) += inverse;
  out.by_coefficients = -inverse * out.position * d.by_coefficients;
  out.valid = d.valid && d.value > 0;
  return out;
}

/// Both models: z of the ray with (x, y) = position, in front of the (last) sphere's centre, where `scale` is beta
/// or 1.
bool sphereDepth(double alpha, double scale, double r2, double& z) {
  const double root = 1 - (2 * alpha - 1) * scale * r2;
  z = (1 - alpha * alpha * scale * r2) / (alpha * std::sqrt(std::max(root, 0.0)) + 1 - alpha);
  return root >= 0;
}

bool doubleSphereRay(const Camera& camera, const Eigen::Vector2d& position, Eigen::Vector3d& ray) {
  const double xi = camera.lens[0], r2 = position.squaredNorm();
  double z = 0;
  const bool valid = sphereDepth(camera.lens[1], 1, r2, z);
  const double root = z * z + (1 - xi * xi) * r2, factor = (z * xi + std::sqrt(std::max(root, 0.0))) / (z * z + r2);
  ray = Eigen::Vector3d(factor * position.x(), factor * position.y(), factor * z - xi).normalized();
  return valid && root >= 0;
}

bool extendedUnifiedRay(const Camera& camera, const Eigen::Vector2d& position, Eigen::Vector3d& ray) {
  double z = 0;
  const bool valid = sphereDepth(camera.lens[0], camera.lens[1], position.squaredNorm(), z);
  ray = Eigen::Vector3d(position.x(), position.y(), z).normalized();
  return valid;
}

}  // namespace

LensImage fisheyeImage(const Camera& camera, const Eigen::Vector3d& p_c) {
  if (camera.model == LensModel::kEquidistant) return equidistantImage(camera, p_c);
  const bool two = camera.model == LensModel::kDoubleSphere;
  return sphereImage(two ? doubleSphere(camera, p_c) : extendedUnified(camera, p_c), p_c);
}

Eigen::Vector2d fisheyePosition(const Camera& camera, const Eigen::Vector3d& p_c) {
  if (camera.model != LensModel::kEquidistant) return fisheyeImage(camera, p_c).position;
  const double r2 = p_c.head<2>().squaredNorm(), r = std::sqrt(r2);
  if (onAxis(r2, p_c.squaredNorm())) return p_c.head<2>() * inverseDepth(p_c);
  return p_c.head<2>() * (RadiusOfAngle(camera, std::atan2(r, p_c.z())).radius / r);
}

bool fisheyeRay(const Camera& camera, const Eigen::Vector2d& position, Eigen::Vector3d& ray) {
  if (camera.model == LensModel::kEquidistant) return equidistantRay(camera, position, ray);
  return camera.model == LensModel::kDoubleSphere ? doubleSphereRay(camera, position, ray)
                                                  : extendedUnifiedRay(camera, position, ray);
}

}  // namespace lintel
