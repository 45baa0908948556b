// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Pose.h"

#include "lintel/geometry/SmallMatrices.h"

namespace lintel {

Pose poseFromMatrix(const Eigen::Matrix4d& T_a_b) {
  const Eigen::Matrix3d R = T_a_b.topLeftCorner<3, 3>();
  const SingularValues3 svd = singularValues(R);
  Eigen::Matrix3d U = svd.U;
  if ((U * svd.V.transpose()).determinant() < 0) U.col(2) *= -1;
  const Eigen::Matrix3d R_orthonormal = U * svd.V.transpose();
  return {Eigen::Quaterniond(R_orthonormal).normalized(), T_a_b.topRightCorner<3, 1>()};
}

Pose interpolate(const Pose& T_w_b0, const Pose& T_w_b1, double s) {
  return {T_w_b0.q.slerp(s, T_w_b1.q).normalized(), (1 - s) * T_w_b0.p + s * T_w_b1.p};
}

}  // namespace lintel
