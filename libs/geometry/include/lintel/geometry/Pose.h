// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lintel {

/// A rigid transform T_a_b: p_a = T_a_b * p_b. `q` is R_a_b (unit), `p` the origin of b in a [m].
struct Pose {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& p_b) const { return q * p_b + p; }
  Pose operator*(const Pose& T_b_c) const { return {(q * T_b_c.q).normalized(), q * T_b_c.p + p}; }
  Pose inverse() const {
    const Eigen::Quaterniond qi = q.conjugate();
    return {qi, -(qi * p)};
  }
  Eigen::Matrix3d R() const { return q.toRotationMatrix(); }
};

/// From a 4x4 homogeneous matrix; the rotation part is projected onto SO(3).
Pose poseFromMatrix(const Eigen::Matrix4d& T_a_b);

/// Straight-line position and slerp rotation between two poses, `s` in [0, 1].
Pose interpolate(const Pose& T_w_b0, const Pose& T_w_b1, double s);

}  // namespace lintel
