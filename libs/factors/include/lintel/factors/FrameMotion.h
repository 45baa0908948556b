// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

/// How a body moves at the time of an image, body axes: what a time offset does to the camera's pose. Taken from the
/// state, not from image velocities, whose noise would be correlated with the observation's own.
struct FrameMotion {
  Eigen::Vector3d v_b = Eigen::Vector3d::Zero();      ///< velocity [m/s]
  Eigen::Vector3d omega_b = Eigen::Vector3d::Zero();  ///< angular rate [rad/s]
};

/// The body's pose when an image was really taken: stamp + offset, with R <- R Exp(omega dt), p <- p + R v dt.
struct ShiftedPose {
  Eigen::Matrix3d R_w_b, R_w_b_stamp, turn;
  Eigen::Vector3d p_w_b;
  Eigen::Quaterniond q_stamp;
  FrameMotion motion;
  double offset_s;

  ShiftedPose(const double* pose, const FrameMotion& m, double offset) : motion(m), offset_s(offset) {
    const Pose T_w_b = poseFromBlock(pose);
    q_stamp = T_w_b.q;
    R_w_b_stamp = T_w_b.R();
    turn = expRotation(m.omega_b * offset).toRotationMatrix();
    R_w_b = R_w_b_stamp * turn;
    p_w_b = T_w_b.p + R_w_b_stamp * (m.v_b * offset);
  }

  /// Jacobian with respect to the pose block, from those to the shifted position and (right) rotation.
  void writePoseJacobian(const Eigen::Matrix<double, 2, 3>& d_position, const Eigen::Matrix<double, 2, 3>& d_rotation,
                         double* out) const {
    Eigen::Map<Eigen::Matrix<double, 2, kPoseSize, Eigen::RowMajor>> J(out);
    J.leftCols<3>() = d_position;
    J.rightCols<4>().noalias() = (d_rotation * turn.transpose() -
                                  d_position * R_w_b_stamp * skew(motion.v_b * offset_s)) * rotationLift(q_stamp);
  }

  /// Derivative with respect to the offset.
  Eigen::Vector2d offsetJacobian(const Eigen::Matrix<double, 2, 3>& d_position,
                                 const Eigen::Matrix<double, 2, 3>& d_rotation) const {
    return d_position * (R_w_b_stamp * motion.v_b) + d_rotation * motion.omega_b;  // Jr(omega dt) omega = omega
  }
};

}  // namespace lintel
