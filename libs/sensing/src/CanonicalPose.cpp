// SPDX-License-Identifier: BSD-3-Clause
#include "CanonicalPose.h"

#include <cmath>

#include "lintel/sensing/Recording.h"

namespace lintel {

Pose canonicalPose(const Pose& pose) {
  Eigen::Vector4d q = pose.q.normalized().coeffs();
  // The first of the components that are largest up to 1e-6: rounding must not decide between equal ones.
  int chosen = 0;
  while (std::abs(q[chosen]) < q.cwiseAbs().maxCoeff() - 1e-6) ++chosen;
  if (q[chosen] < 0) q = -q;
  const double grid = std::ldexp(1.0, -40);
  double rest = 1.0;
  for (int i = 0; i < 4; ++i) {
    if (i == chosen) continue;
    q[i] = std::round(q[i] / grid) * grid + 0.0;  // + 0.0: no negative zero
    rest -= q[i] * q[i];
  }
  q[chosen] = std::sqrt(rest);
  return {Eigen::Quaterniond(q), pose.p};
}

Pose calibratedPose(const Eigen::Matrix4d& T_a_b, const std::string& where) {
  if (!T_a_b.allFinite()) throw RecordingError(where + ": not finite: correct the sensor's pose");
  const Eigen::Matrix3d R = T_a_b.topLeftCorner<3, 3>();
  const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 1e-3 || R.determinant() < 0)
    throw RecordingError(where + ": its upper left 3x3 part is no rotation: correct the sensor's pose");
  if ((T_a_b.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-9)
    throw RecordingError(where + ": its last row is not 0 0 0 1: correct the sensor's pose");
  return canonicalPose(poseFromMatrix(T_a_b));
}

}  // namespace lintel
