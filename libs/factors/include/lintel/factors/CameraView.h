// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/factors/FrameMotion.h"
#include "lintel/factors/StateBlocks.h"

namespace lintel {

constexpr int kCameraTangent = 6;

/// Where the camera was when an image was taken, and how that hangs on the states: what all residuals of an image have
/// in common. Tangent of the camera's pose: p_w_c += dp, R_w_c <- R_w_c Exp(dtheta).
///
///   R_w_c = R_w_b Exp(omega td) R_b_c,    p_w_c = p_w_b + R_w_b (v td + Exp(omega td) p_b_c)
struct CameraView {
  Eigen::Matrix3d R_c_w;
  Eigen::Vector3d p_w_c;
  Eigen::Matrix<double, kCameraTangent, kPoseTangent> d_pose, d_extrinsics;  ///< with respect to their tangents
  Eigen::Matrix<double, kCameraTangent, 1> d_offset;  ///< with respect to the time offset; always set

  /// From blocks as the factors get them. The other derivatives are only set when they are asked for.
  CameraView(const double* pose, const double* extrinsics, const double* correction, const FrameMotion& motion,
             bool derivatives);
};

}  // namespace lintel
