// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/inertial/Preintegration.h"

namespace lintel {

/// What the axes of an IMU are wrong by: where f and w are measured the specific force is f + A (f - mean_f) and the
/// angular rate w + G w, less the biases. On the diagonals are errors of the axes' scales, beside them those of their
/// directions [rad]. Sensors of telephones and depth cameras have some per cent of both. What A would add to the mean
/// cannot be told from a bias, and is left to that. G is symmetric: the body's frame is turned as the gyroscope's axes
/// are in the mean, and a rotation between both sensors is part of A.
struct ImuAxes {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_f = Eigen::Vector3d::Zero();  ///< of a recording, in the body frame [m/s^2]
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
};

/// The A of samples that are corrected by `first`, then by `second`.
Eigen::Matrix3d followedBy(const Eigen::Matrix3d& first, const Eigen::Matrix3d& second);

/// The samples as if the IMU had right axes.
ImuBatch withAxes(ImuBatch samples, const ImuAxes& axes);

/// The same interval as if its IMU had right axes.
Preintegration withAxes(const Preintegration& imu, const ImuAxes& axes);

}  // namespace lintel
