// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/PointFactor.h"

#include <cmath>

namespace lintel {

bool PointFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const double* correction = parameters[2];
  const ShiftedPose T_w_b(parameters[0], motion_, correction[kTimeOffsetAt]);
  const Pose T_b_c = poseFromBlock(parameters[1]);
  const Eigen::Vector3d X = Eigen::Vector3d::Map(parameters[3]);
  const double w = parameters[3][3];
  const PinholeRadtan camera = correctedCamera(camera_, correction);
  const Eigen::Matrix3d R_b_w = T_w_b.R_w_b.transpose(), R_c_b = T_b_c.R().transpose();

  const Eigen::Vector3d from_body_w = origin_w_ - T_w_b.p_w_b;
  const Eigen::Vector3d g_b = R_b_w * (X + w * from_body_w);  // seen from the body's origin, scaled by w
  const Eigen::Vector3d g_c = R_c_b * (g_b - w * T_b_c.p);
  const double z = std::abs(g_c.z()) > 1e-9 ? g_c.z() : 1e-9;
  const Eigen::Vector2d n = g_c.head<2>() / z, distorted = camera.distort(n);
  Eigen::Map<Eigen::Vector2d> r(residuals);
  r = weight_ * (Eigen::Vector2d(camera.fx * distorted.x() + camera.cx, camera.fy * distorted.y() + camera.cy) - px_);
  if (!jacobians) return true;

  const Eigen::Vector2d focal(weight_ * camera.fx, weight_ * camera.fy);
  Eigen::Matrix<double, 2, 3> d_n;  // d n / d g_c
  d_n << 1 / z, 0, -n.x() / z, 0, 1 / z, -n.y() / z;
  const Eigen::Matrix<double, 2, 3> d_g = focal.asDiagonal() * camera.distortJacobian(n) * d_n;
  const Eigen::Matrix<double, 2, 3> d_gb = d_g * R_c_b;
  const Eigen::Matrix<double, 2, 3> d_gw = d_gb * R_b_w;
  const Eigen::Matrix<double, 2, 3> d_position = -w * d_gw, d_rotation = d_gb * skew(g_b);
  if (jacobians[0]) T_w_b.writePoseJacobian(d_position, d_rotation, jacobians[0]);
  if (jacobians[1]) {
    Eigen::Map<Eigen::Matrix<double, 2, kPoseSize, Eigen::RowMajor>> J(jacobians[1]);
    J.leftCols<3>() = -w * d_gb;
    J.rightCols<4>() = d_g * skew(g_c) * rotationLift(T_b_c.q);
  }
  if (jacobians[2]) {
    const double r2 = n.squaredNorm();
    Eigen::Map<Eigen::Matrix<double, 2, kCorrectionSize, Eigen::RowMajor>> J(jacobians[2]);
    J.row(0) << weight_ * distorted.x(), 0, weight_, 0, focal.x() * n.x() * r2, focal.x() * n.x() * r2 * r2, 0;
    J.row(1) << 0, weight_ * distorted.y(), 0, weight_, focal.y() * n.y() * r2, focal.y() * n.y() * r2 * r2, 0;
    J.col(kTimeOffsetAt) = T_w_b.offsetJacobian(d_position, d_rotation);
  }
  if (jacobians[3]) {
    Eigen::Map<Eigen::Matrix<double, 2, kPointSize, Eigen::RowMajor>> J(jacobians[3]);
    J.leftCols<3>() = d_gw;
    J.col(3) = d_gw * from_body_w - d_gb * T_b_c.p;
  }
  return true;
}

}  // namespace lintel
