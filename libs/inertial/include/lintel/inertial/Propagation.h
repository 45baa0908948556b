// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lintel/geometry/Pose.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {

/// Pose and velocity of the body in the world, and the biases of its IMU.
struct InertialState {
  Pose T_w_b;
  Eigen::Vector3d v_w_b = Eigen::Vector3d::Zero();  ///< [m/s]
  ImuBias bias;
};

/// The state at the end of a pre-integrated interval that starts in state `from`, by the samples alone
/// [Forster2017, eq. 26]; the biases stay.
InertialState propagated(const InertialState& from, const Preintegration& imu);

/// Pre-integrations from the first of the samples of `whole` to each of `times_ns`, ascending and within the samples,
/// with the noise of `whole`. A time between two samples gets one interpolated.
std::vector<Preintegration> integratedTo(const ImuBias& bias, const Preintegration& whole,
                                         const std::vector<std::int64_t>& times_ns);

/// Covariance of a state's error: position [m] (world axes), rotation [rad] (R <- R Exp(dtheta)), velocity [m/s], gyro
/// bias [rad/s], accelerometer bias [m/s^2]; three numbers each.
using StateCovariance = Eigen::Matrix<double, 15, 15>;

/// The covariance of propagated(from, imu) when `from` has this one: the error is carried along to first order, the
/// noise of the samples and the walk of the biases are added.
StateCovariance propagatedCovariance(const InertialState& from, const Preintegration& imu,
                                     const StateCovariance& covariance);

/// How far a state is from where the samples lead to from another one, in pose and velocity, measured by the covariance
/// of the interval: a chi-square with nine degrees of freedom where both states are right.
double squaredMisfit(const InertialState& from, const InertialState& to, const Preintegration& imu);

/// The same of velocity and position alone, which the accelerometer is asked for: six degrees of freedom.
double squaredAccelMisfit(const InertialState& from, const InertialState& to, const Preintegration& imu);

}  // namespace lintel
