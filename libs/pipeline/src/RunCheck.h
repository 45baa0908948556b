// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>

#include "lintel/core/Rig.h"
#include "lintel/inertial/AccelerometerCheck.h"
#include "lintel/inertial/NoiseMeter.h"
#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// Looks for contradictions in a run, while it goes on.
class RunCheck {
 public:
  explicit RunCheck(const Rig& rig) : rig_(rig) {}

  /// A frame's IMU and what the estimator made of it.
  void add(const ImuBatch& imu, const WindowUpdate& update);

  /// Why the trajectory must not be trusted, with the likely cause; empty when nothing contradicts it.
  std::string verdict(const OdometryStatistics& statistics) const;

  /// What of the IMU's noise densities was not believed, in words; empty when all were.
  std::string noiseRemark() const { return lintel::noiseRemark(rig_.imu_noise, noise_); }

 private:
  struct Speed {
    std::int64_t t_ns;
    Eigen::Vector3d v_w_b;
  };

  void watchSpeed(const WindowUpdate& update);

  Rig rig_;
  AccelerometerCheck accelerometer_;
  NoiseMeter noise_;
  Eigen::Vector3d bias_gyro_ = Eigen::Vector3d::Zero();
  std::deque<Speed> speeds_;         ///< of the last seconds, without a reset in between
  double largest_acceleration_ = 0;  ///< that lasted as long [m/s^2]
};

}  // namespace lintel
