// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/LineFactor.h"

#include <algorithm>
#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {

bool LineFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const ShiftedPose T_w_b(parameters[0], motion_, parameters[2][kTimeOffsetAt]);
  const Pose T_b_c = poseFromBlock(parameters[1]);
  const OrthonormalLine line = lineFromBlock(parameters[3]);
  const Eigen::Matrix3d U = line.U.toRotationMatrix();
  const double cosine = std::cos(line.phi), sine = std::sin(line.phi);
  const Eigen::Vector3d n_w = cosine * U.col(0), d_w = sine * U.col(1);
  const Eigen::Matrix3d &R_w_b = T_w_b.R_w_b, R_b_w = R_w_b.transpose(), R_c_b = T_b_c.R().transpose();
  const Eigen::Vector3d p_w_c = R_w_b * T_b_c.p + T_w_b.p_w_b;
  const Eigen::Vector3d n_b = R_b_w * (n_w + (origin_w_ - p_w_c).cross(d_w));  // moment about the camera, body axes
  const Eigen::Vector3d l = R_c_b * n_b;
  const double m = std::max(l.head<2>().norm(), 1e-12);

  const Eigen::Vector3d ends[2] = {start_.corrected(parameters[2]).homogeneous(), end_.corrected(parameters[2]).homogeneous()};
  const Eigen::Vector2d normal = l.head<2>() / m;
  Eigen::Matrix<double, 2, 3> d_l;  // d r / d l
  for (int k = 0; k < 2; ++k) {
    const double distance = ends[k].dot(l) / m;
    residuals[k] = weight_ * distance;
    d_l.row(k) = weight_ / m * (ends[k].transpose() - distance * Eigen::RowVector3d(normal.x(), normal.y(), 0));
  }
  if (!jacobians) return true;

  const Eigen::Matrix<double, 2, 3> d_nb = d_l * R_c_b;
  const Eigen::Matrix<double, 2, 3> d_nw = d_nb * R_b_w;
  const Eigen::Matrix<double, 2, 3> d_centre = d_nw * skew(d_w);  // d r / d p_w_c
  const Eigen::Matrix<double, 2, 3> d_rotation = d_nb * skew(n_b) - d_centre * R_w_b * skew(T_b_c.p);
  if (jacobians[0]) T_w_b.writePoseJacobian(d_centre, d_rotation, jacobians[0]);
  if (jacobians[1]) {
    Eigen::Map<Eigen::Matrix<double, 2, kPoseSize, Eigen::RowMajor>> J(jacobians[1]);
    J.leftCols<3>() = d_centre * R_w_b;
    J.rightCols<4>() = d_l * skew(l) * rotationLift(T_b_c.q);
  }
  if (jacobians[2]) {
    Eigen::Map<Eigen::Matrix<double, 2, kCorrectionSize, Eigen::RowMajor>> J(jacobians[2]);
    J.row(0) = weight_ * normal.transpose() * start_.correction_jacobian;
    J.row(1) = weight_ * normal.transpose() * end_.correction_jacobian;
    J.col(kTimeOffsetAt) += T_w_b.offsetJacobian(d_centre, d_rotation);
  }
  if (jacobians[3]) {
    const Eigen::Matrix<double, 2, 3> d_dw = d_nw * skew(origin_w_ - p_w_c);
    // u1 and u2 turn with U: d(U e) = -U [e]x dpsi
    const Eigen::Matrix<double, 2, 3> d_psi = -cosine * d_nw * U * skew(Eigen::Vector3d::UnitX()) -
                                              sine * d_dw * U * skew(Eigen::Vector3d::UnitY());
    Eigen::Map<Eigen::Matrix<double, 2, kLineSize, Eigen::RowMajor>> J(jacobians[3]);
    J.leftCols<4>() = d_psi * rotationLift(line.U);
    J.col(4) = -sine * d_nw * U.col(0) + cosine * d_dw * U.col(1);
  }
  return true;
}

}  // namespace lintel
