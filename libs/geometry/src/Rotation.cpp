// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Rotation.h"

#include <cmath>

namespace lintel {

namespace {
constexpr double kSmallAngle = 1e-5;  // below, Taylor series to the order that double precision sees
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Quaterniond expRotation(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double half_sinc = angle < kSmallAngle ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = half_sinc * phi;
  return q.normalized();
}

Eigen::Vector3d logRotation(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  if (sine < kSmallAngle) return 2.0 * sign * q.vec() / std::abs(q.w());
  const double angle = 2.0 * std::atan2(sine, std::abs(q.w()));
  return sign * angle / sine * q.vec();
}

Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm(), angle = std::sqrt(angle2);
  const Eigen::Matrix3d S = skew(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() - 0.5 * S + S * S / 6.0;
  return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / angle2 * S +
         (angle - std::sin(angle)) / (angle2 * angle) * S * S;
}

Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& phi) {
  const double angle2 = phi.squaredNorm(), angle = std::sqrt(angle2);
  const Eigen::Matrix3d S = skew(phi);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * S + S * S / 12.0;
  // 1/a^2 - (1 + cos a) / (2 a sin a), written with cot(a/2) so that it stays finite at pi
  const double c = (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / angle2;
  return Eigen::Matrix3d::Identity() + 0.5 * S + c * S * S;
}

/// As Eigen::Quaterniond::FromTwoVectors, whose singular value decomposition for opposite directions takes seconds of
/// compile time.
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized(), axis = a.cross(b);
  const double cosine = b.dot(a);
  Eigen::Quaterniond q;
  if (cosine < -1 + 1e-12) {
    const double sine = axis.norm(), cosine_of_half = 0.5 * sine;
    q.vec() = sine > 1e-9 ? Eigen::Vector3d(axis / sine) : Eigen::Vector3d(tangentBasis(a).col(0));
    q.vec() *= std::sqrt(1 - cosine_of_half * cosine_of_half);
    q.w() = cosine_of_half;
  } else {
    const double s = std::sqrt((1 + cosine) * 2);
    q.vec() = axis * (1 / s);
    q.w() = s * 0.5;
  }
  return q.normalized();
}

double yawOf(const Eigen::Quaterniond& R_w_b) { return 2.0 * std::atan2(R_w_b.z(), R_w_b.w()); }

Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d z = direction.normalized();
  Eigen::Index smallest;
  z.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = z.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  basis.col(1) = z.cross(basis.col(0));
  return basis;
}

}  // namespace lintel
