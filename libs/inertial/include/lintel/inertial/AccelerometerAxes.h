// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/inertial/Preintegration.h"

namespace lintel {

/// What an accelerometer's axes are wrong by: where f is measured the specific force is f + A (f - mean_f), less the
/// bias. On the diagonal of A are errors of the axes' scales, beside it those of their directions [rad]. Sensors of
/// telephones and depth cameras have some per cent of both. What A would add to the mean cannot be told from a bias,
/// and is left to that.
struct AccelerometerAxes {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_f = Eigen::Vector3d::Zero();  ///< of a recording, in the body frame [m/s^2]
};

/// The A of samples that are corrected by `first`, then by `second`.
Eigen::Matrix3d followedBy(const Eigen::Matrix3d& first, const Eigen::Matrix3d& second);

/// d (delta_v, delta_p) / d A, by the rows of A one after the other. Exact for any A, as both are linear in it.
using AxesJacobian = Eigen::Matrix<double, 6, 9>;
AxesJacobian axesJacobian(const Preintegration& imu, const Eigen::Vector3d& mean_f);

/// The samples as if the accelerometer had right axes.
ImuBatch withAxes(ImuBatch samples, const AccelerometerAxes& axes);

/// The same interval as if its accelerometer had right axes.
Preintegration withAxes(const Preintegration& imu, const AccelerometerAxes& axes);

}  // namespace lintel
