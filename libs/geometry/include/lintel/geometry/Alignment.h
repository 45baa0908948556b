// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// What may differ between an estimated trajectory's frame and the true one.
enum class AlignmentKind {
  kNone,  ///< nothing
  kSe3,   ///< rotation and translation (6 DoF)
  kYaw,   ///< rotation about z and translation: what a visual-inertial system cannot observe (4 DoF)
  kSim3,  ///< rotation, translation and scale (7 DoF)
};

/// "none", "se3", "yaw" or "sim3"; throws std::invalid_argument on any other name.
AlignmentKind alignmentKindOf(const std::string& name);
std::string nameOf(AlignmentKind kind);

/// A similarity: p_a = scale * (R_a_b * p_b) + p_a_b, with R_a_b and p_a_b in `T_a_b`.
struct Similarity {
  double scale = 1;
  Pose T_a_b;

  Eigen::Vector3d operator*(const Eigen::Vector3d& p_b) const { return scale * (T_a_b.q * p_b) + T_a_b.p; }
};

/// The least-squares transform of `kind` that takes positions `from_b` to their partners `to_a`, all [m]
/// [Umeyama1991]; the yaw form is the same problem restricted to rotations about z, in closed form.
/// What the positions do not determine (a rotation about a straight line) is arbitrary; the scale is 1 when `from_b`
/// does not move. Throws std::invalid_argument when the numbers of positions differ or there are none.
Similarity alignPositions(AlignmentKind kind, const std::vector<Eigen::Vector3d>& from_b,
                          const std::vector<Eigen::Vector3d>& to_a);

}  // namespace lintel
