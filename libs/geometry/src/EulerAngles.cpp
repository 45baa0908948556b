// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/EulerAngles.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

/// d theta / d (yaw, pitch, roll).
Eigen::Matrix3d thetaByEuler(const Eigen::Quaterniond& q) {
  const Eigen::RowVector3d z_b = q.toRotationMatrix().row(2);  // (-sin p, cos p sin r, cos p cos r)
  const double cosine = std::hypot(z_b[1], z_b[2]), kept = std::max(cosine, 1e-6);
  const double sine_roll = cosine > 0 ? z_b[1] / cosine : 0, cosine_roll = cosine > 0 ? z_b[2] / cosine : 1;
  Eigen::Matrix3d J;
  J << z_b[0], 0, 1,                     //
      kept * sine_roll, cosine_roll, 0,  //
      kept * cosine_roll, -sine_roll, 0;
  return J;
}

PoseCovariance turned(const PoseCovariance& covariance, const Eigen::Matrix3d& J) {
  PoseCovariance by = PoseCovariance::Identity();
  by.bottomRightCorner<3, 3>() = J;
  return by * covariance * by.transpose();
}

}  // namespace

PoseCovariance toEulerCovariance(const PoseCovariance& covariance, const Eigen::Quaterniond& R) {
  return turned(covariance, thetaByEuler(R).inverse());
}

PoseCovariance fromEulerCovariance(const PoseCovariance& covariance, const Eigen::Quaterniond& R) {
  return turned(covariance, thetaByEuler(R));
}

}  // namespace lintel
