// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lintel {

using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// Covariances of a pose in two coordinates: (p, theta) with p <- p + dp and R <- R Exp(dtheta), and
/// (x, y, z, yaw, pitch, roll) with R = Rz(yaw) Ry(pitch) Rx(roll), as MRPT's CPose3DPDFGaussian has it. The second is
/// singular where the body's x axis is vertical; nearer to it than 1e-6 rad, a pose 1e-6 rad away stands in.
PoseCovariance toEulerCovariance(const PoseCovariance& covariance, const Eigen::Quaterniond& R);
PoseCovariance fromEulerCovariance(const PoseCovariance& covariance, const Eigen::Quaterniond& R);

}  // namespace lintel
