// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "lintel/core/Frame.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {

/// What the IMU measures at one time, by the samples around it; biases included.
struct ImuAt {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();        ///< [rad/s]
  Eigen::Vector3d gyro_slope = Eigen::Vector3d::Zero();  ///< [rad/s^2]
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();       ///< specific force [m/s^2]
};

/// Samples that are at most so far away count at an image (10 ms, and a little for stamps that are not exact). Within
/// it a hand's or a vehicle's motion is steady, while motors' vibrations, which images with their exposure do not
/// follow, average out.
constexpr double kImuReach_s = 0.0105;

/// At the time t where `before` ends and `after` begins (one may be empty), by the samples within `reach_s` of it: the
/// line that fits their angular rates best, and the mean of their specific forces. Nothing where there are too few.
std::optional<ImuAt> imuAt(const ImuBatch& before, const ImuBatch& after, double reach_s = kImuReach_s);

/// The same between two intervals; null for one that is not known.
std::optional<ImuAt> imuAt(const Preintegration* before, const Preintegration* after, double reach_s = kImuReach_s);

/// The angular rate that the last sample of an interval shows [rad/s], its bias where there is none.
Eigen::Vector3d gyroAtEnd(const Preintegration& imu);

/// How a body's motion changes at one time, body axes.
struct MotionChange {
  Eigen::Vector3d acceleration_b = Eigen::Vector3d::Zero();          ///< of the body in the world [m/s^2]
  Eigen::Vector3d angular_acceleration_b = Eigen::Vector3d::Zero();  ///< [rad/s^2]
};

/// a_b = f - b_a + R_w_b^T g_w, and the slope of the angular rate.
MotionChange motionChange(const ImuAt& imu, const Eigen::Vector3d& accel_bias, const Eigen::Quaterniond& R_w_b,
                          const Eigen::Vector3d& gravity_w);

}  // namespace lintel
