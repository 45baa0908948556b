// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Gyro bias from images and gyroscope, without translation or structure: between two cameras all epipolar plane
/// normals x_a x (R_ab x_b) are perpendicular to the translation, whatever its length. The bias that makes them so for
/// many pairs of frames at once is found by Gauss-Newton [Kneip2013, He2023]. Robust to outliers (Cauchy weights).
/// Returns the bias [rad/s]; `rms_rad` is the remaining coplanarity error.
struct GyroAlignment {
  Eigen::Vector3d bias_gyro = Eigen::Vector3d::Zero();
  double rms_rad = 0;
  bool ok = false;
};
GyroAlignment alignGyro(const SlidingWindow& window);

/// R_b0_bk of every window frame from the pre-integrations (at their present biases).
std::vector<Eigen::Quaterniond> integratedRotations(const SlidingWindow& window);

}  // namespace lintel
