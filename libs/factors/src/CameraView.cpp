// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/CameraView.h"

#include "lintel/geometry/Rotation.h"

namespace lintel {

CameraView::CameraView(const double* pose, const double* extrinsics, const double* correction,
                       const FrameMotion& motion, bool derivatives) {
  const Pose T_w_b = poseFromBlock(pose), T_b_c = poseFromBlock(extrinsics);
  const double offset_s = correction[kTimeOffsetAt];
  const Eigen::Matrix3d R_stamp = T_w_b.R(), turn = expRotation(motion.omega_b * offset_s).toRotationMatrix();
  const Eigen::Matrix3d R_w_b = R_stamp * turn, R_c_b = T_b_c.R().transpose();
  R_c_w = (R_w_b * T_b_c.R()).transpose();
  p_w_c = T_w_b.p + R_stamp * (motion.v_b * offset_s) + R_w_b * T_b_c.p;
  if (!derivatives) return;
  d_pose << Eigen::Matrix3d::Identity(), -R_stamp * skew(motion.v_b * offset_s + turn * T_b_c.p),
      Eigen::Matrix3d::Zero(), R_c_b * turn.transpose();
  d_extrinsics << R_w_b, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
  d_offset << R_stamp * motion.v_b + R_w_b * motion.omega_b.cross(T_b_c.p), R_c_b * motion.omega_b;  // Jr(w dt) w = w
}

void CameraView::writeJacobians(const double* pose, const double* extrinsics, const CameraJacobian& d_camera,
                                const IntrinsicsJacobian& d_intrinsics, double** jacobians) const {
  const auto writePose = [&](const Eigen::Matrix<double, kCameraTangent, kPoseTangent>& d_block, const double* block,
                             double* out) {
    const Eigen::Matrix<double, 2, kPoseTangent> tangent = d_camera * d_block;
    Eigen::Map<Eigen::Matrix<double, 2, kPoseSize, Eigen::RowMajor>> J(out);
    J.leftCols<3>() = tangent.leftCols<3>();
    J.rightCols<4>() = tangent.rightCols<3>() * rotationLift(poseFromBlock(block).q);
  };
  if (jacobians[0]) writePose(d_pose, pose, jacobians[0]);
  if (jacobians[1]) writePose(d_extrinsics, extrinsics, jacobians[1]);
  if (jacobians[2]) {
    Eigen::Map<Eigen::Matrix<double, 2, kCorrectionSize, Eigen::RowMajor>> J(jacobians[2]);
    J.leftCols<kIntrinsicsSize>() = d_intrinsics;
    J.col(kTimeOffsetAt) = d_camera * d_offset;
  }
}

}  // namespace lintel
