// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// `pose` with its rotation on a grid that survives every way of storing it.
///
/// A rawlog stores a rotation as a quaternion that has been through a matrix, which changes its last bits. So that a
/// folder and the rawlog made from it give the same bytes, both readers round three components of the quaternion to
/// multiples of 2^-40 (1e-12: 1e5 times finer than any calibration) and compute the largest from them:
/// canonicalPose(store(canonicalPose(T))) = canonicalPose(T) exactly, for errors of store() below 4e-13.
Pose canonicalPose(const Pose& pose);

/// Pose from a homogeneous matrix, canonical. Throws RecordingError naming `where` when it is not finite or its
/// rotation part is further than 1e-3 from a rotation.
Pose calibratedPose(const Eigen::Matrix4d& T_a_b, const std::string& where);

}  // namespace lintel
