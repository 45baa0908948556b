// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/PointFactor.h"

#include <algorithm>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

using Jacobian2Pose = Eigen::Matrix<double, 2, kPoseSize, Eigen::RowMajor>;

void writePoseJacobian(double* out, const Eigen::Matrix<double, 2, 3>& d_position,
                       const Eigen::Matrix<double, 2, 3>& d_rotation, const Eigen::Quaterniond& q) {
  Eigen::Map<Jacobian2Pose> J(out);
  J.leftCols<3>() = d_position;
  J.rightCols<4>().noalias() = d_rotation * rotationLift(q);
}

}  // namespace

bool PointFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Pose T_w_bi = poseFromBlock(parameters[0]), T_w_bj = poseFromBlock(parameters[1]), T_b_c = poseFromBlock(parameters[2]);
  const double lambda = parameters[4][0];
  const Eigen::Vector3d ray_ci = host_.corrected(parameters[3]).homogeneous();
  const Eigen::Matrix3d R_w_bi = T_w_bi.R(), R_bj_w = T_w_bj.R().transpose(), R_b_c = T_b_c.R();

  // positions scaled by lambda, so that points at infinity stay finite
  const Eigen::Vector3d g_bi = R_b_c * ray_ci + lambda * T_b_c.p;
  const Eigen::Vector3d g_bj = R_bj_w * (R_w_bi * g_bi + lambda * (T_w_bi.p - T_w_bj.p));
  const Eigen::Vector3d g_cj = R_b_c.transpose() * (g_bj - lambda * T_b_c.p);
  const double z = std::abs(g_cj.z()) > 1e-6 ? g_cj.z() : 1e-6;

  Eigen::Map<Eigen::Vector2d> r(residuals);
  r = weight_ * (g_cj.head<2>() / z - target_.corrected(parameters[3]));
  if (!jacobians) return true;

  Eigen::Matrix<double, 2, 3> d_g;  // d r / d g_cj
  d_g << 1, 0, -g_cj.x() / z, 0, 1, -g_cj.y() / z;
  d_g *= weight_ / z;
  const Eigen::Matrix<double, 2, 3> d_gbj = d_g * R_b_c.transpose();
  const Eigen::Matrix<double, 2, 3> d_gw = d_gbj * R_bj_w;
  const Eigen::Matrix<double, 2, 3> d_gbi = d_gw * R_w_bi;
  if (jacobians[0]) writePoseJacobian(jacobians[0], lambda * d_gw, -d_gbi * skew(g_bi), T_w_bi.q);
  if (jacobians[1]) writePoseJacobian(jacobians[1], -lambda * d_gw, d_gbj * skew(g_bj), T_w_bj.q);
  const Eigen::Matrix<double, 2, 3> d_ray = d_gbi * R_b_c;
  if (jacobians[2])
    writePoseJacobian(jacobians[2], lambda * (d_gbi - d_gbj), d_g * skew(g_cj) - d_ray * skew(ray_ci), T_b_c.q);
  if (jacobians[3]) {
    Eigen::Map<Eigen::Matrix<double, 2, kCorrectionSize, Eigen::RowMajor>> J(jacobians[3]);
    J = d_ray.leftCols<2>() * host_.correction_jacobian - weight_ * target_.correction_jacobian;
  }
  if (jacobians[4]) {
    Eigen::Map<Eigen::Vector2d> J(jacobians[4]);
    J = d_gbj * (R_bj_w * (R_w_bi * T_b_c.p + T_w_bi.p - T_w_bj.p) - T_b_c.p);
  }
  return true;
}

}  // namespace lintel
