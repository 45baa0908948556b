// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lintel {

/// Cross-product matrix: skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Exp: so(3) -> SO(3). `phi` rotation vector [rad].
Eigen::Quaterniond expRotation(const Eigen::Vector3d& phi);

/// Log: SO(3) -> so(3), ‖result‖ <= pi [rad]. q and -q give the same result.
Eigen::Vector3d logRotation(const Eigen::Quaterniond& q);

/// Right Jacobian of SO(3): Exp(phi + d) = Exp(phi) Exp(J d) to first order [Forster2017, eq. 8].
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& phi);

/// Inverse of rightJacobian(phi): Log(Exp(phi) Exp(d)) = phi + J^-1 d to first order [Forster2017, eq. 9].
Eigen::Matrix3d rightJacobianInverse(const Eigen::Vector3d& phi);

/// The shortest rotation R with R * from ∥ to. Directions need not be unit vectors, but not be zero.
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Yaw of a rotation R_w_b about the world's z [rad], in (-2 pi, 2 pi): the twist of its swing-twist decomposition.
/// Well defined however the body is mounted, except upside down.
double yawOf(const Eigen::Quaterniond& R_w_b);

/// An orthonormal basis (3x2) of the plane perpendicular to `direction`; deterministic.
Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& direction);

}  // namespace lintel
