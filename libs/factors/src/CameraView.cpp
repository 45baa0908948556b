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
  d_offset << R_stamp * motion.v_b + R_w_b * motion.omega_b.cross(T_b_c.p), R_c_b * motion.omega_b;  // Jr(w dt) w = w
  if (!derivatives) return;
  d_pose << Eigen::Matrix3d::Identity(), -R_stamp * skew(motion.v_b * offset_s + turn * T_b_c.p),
      Eigen::Matrix3d::Zero(), R_c_b * turn.transpose();
  d_extrinsics << R_w_b, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
}

}  // namespace lintel
