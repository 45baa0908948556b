// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "lintel/core/Frame.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {

/// How a body's motion changes at one time, body axes.
struct MotionChange {
  Eigen::Vector3d acceleration_b = Eigen::Vector3d::Zero();          ///< of the body in the world [m/s^2]
  Eigen::Vector3d angular_acceleration_b = Eigen::Vector3d::Zero();  ///< [rad/s^2]
};

/// At the time t where `before` ends and `after` begins (one may be empty), by the samples within `reach_s` of it: the
/// mean of the specific force f, and the slope of the angular rate by least squares.
///
///   a_b = mean(f) - b_a + R_w_b^T g_w,    alpha = sum (t_k - mean(t)) w_k / sum (t_k - mean(t))^2
///
/// Zero where there are too few samples to tell.
MotionChange motionChange(const ImuBatch& before, const ImuBatch& after, double reach_s, const ImuBias& bias,
                          const Eigen::Quaterniond& R_w_b, const Eigen::Vector3d& gravity_w);

}  // namespace lintel
