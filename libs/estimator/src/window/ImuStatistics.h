// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Means and standard deviations (norm over the axes) of IMU samples.
struct ImuStatistics {
  Eigen::Vector3d mean_gyro = Eigen::Vector3d::Zero(), mean_accel = Eigen::Vector3d::Zero();  ///< [rad/s], [m/s^2]
  double std_gyro = 0, std_accel = 0;
  std::size_t samples = 0;
};

/// Of the samples that lead to the frames from `first` on.
ImuStatistics imuStatistics(const SlidingWindow& window, std::size_t first);

}  // namespace lintel
