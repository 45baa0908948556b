// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/VanishingFactor.h"

#include <algorithm>

#include "lintel/geometry/Rotation.h"

namespace lintel {

void VanishingFactor::linearise(const CameraView& view, const double* correction, const double* direction,
                                bool jacobians, VanishingLinearisation& out) const {
  const Eigen::Vector3d start = start_.corrected(correction).homogeneous(),
                        end = end_.corrected(correction).homogeneous();
  const Eigen::Vector3d cross = start.cross(end), d_c = view.R_c_w * Eigen::Vector3d::Map(direction);
  const double norm = std::max(cross.norm(), 1e-12);
  const Eigen::Vector3d n = cross / norm;
  out.residual = weight_ * n.dot(d_c);
  if (!jacobians) return;
  out.d_camera << 0, 0, 0, weight_ * n.transpose() * skew(d_c);             // R_c_w <- Exp(-dtheta) R_c_w
  const Eigen::Vector3d d_cross = weight_ / norm * (d_c - n.dot(d_c) * n);  // d r / d cross
  const Eigen::Vector3d d_start = end.cross(d_cross), d_end = d_cross.cross(start);
  out.d_intrinsics = d_start.head<2>().transpose() * start_.correction_jacobian.leftCols<kIntrinsicsSize>() +
                     d_end.head<2>().transpose() * end_.correction_jacobian.leftCols<kIntrinsicsSize>();
  out.d_direction = weight_ * n.transpose() * view.R_c_w;
}

bool VanishingFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const CameraView view(parameters[0], parameters[1], parameters[2], motion_, jacobians != nullptr);
  VanishingLinearisation result;
  linearise(view, parameters[2], parameters[3], jacobians != nullptr, result);
  residuals[0] = result.residual;
  if (!jacobians) return true;
  const auto writePose = [&](const Eigen::Matrix<double, kCameraTangent, kPoseTangent>& d_block, const double* block,
                             double* out) {
    const Eigen::Matrix<double, 1, kPoseTangent> tangent = result.d_camera * d_block;
    Eigen::Map<Eigen::Matrix<double, 1, kPoseSize>> J(out);
    J.head<3>() = tangent.head<3>();
    J.tail<4>() = tangent.tail<3>() * rotationLift(poseFromBlock(block).q);
  };
  if (jacobians[0]) writePose(view.d_pose, parameters[0], jacobians[0]);
  if (jacobians[1]) writePose(view.d_extrinsics, parameters[1], jacobians[1]);
  if (jacobians[2]) {
    Eigen::Map<Eigen::Matrix<double, 1, kCorrectionSize>> J(jacobians[2]);
    J.head<kIntrinsicsSize>() = result.d_intrinsics;
    J[kTimeOffsetAt] = result.d_camera * view.d_offset;
  }
  if (jacobians[3]) std::copy_n(result.d_direction.data(), kDirectionSize, jacobians[3]);
  return true;
}

}  // namespace lintel
