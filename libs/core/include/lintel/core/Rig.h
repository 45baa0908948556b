// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "lintel/core/Frame.h"
#include "lintel/geometry/Camera.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Pose.h"

namespace lintel {

/// Continuous-time noise densities of an IMU, as in EuRoC's sensor.yaml.
struct ImuNoise {
  double gyro_noise = 1.6968e-4;  ///< [rad/s/sqrt(Hz)]
  double gyro_walk = 1.9393e-5;   ///< [rad/s^2/sqrt(Hz)]
  double accel_noise = 2.0e-3;    ///< [m/s^2/sqrt(Hz)]
  double accel_walk = 3.0e-3;     ///< [m/s^3/sqrt(Hz)]
  /// Standard deviation of the accelerometer's exponentially correlated noise, a first-order Gauss-Markov process on
  /// each axis [m/s^2]: errors of scale and alignment that change with the motion, vibration that aliases.
  double accel_correlated = 0;
};

/// The correlation time of ImuNoise::accel_correlated [s].
constexpr double kAccelCorrelation_s = 1;

/// What the axes of an IMU are wrong by, 0 where they are right: where f and w are measured, the specific force is
/// f + A f and the angular rate w + G w, less the biases.
struct AxesErrors {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero(), G = Eigen::Matrix3d::Zero();

  bool none() const { return A.isZero(0) && G.isZero(0); }
};

/// Calibration of the sensors that Lintel uses: one camera and one IMU. The body frame is the IMU's.
struct Rig {
  Camera camera;
  Pose T_b_c;  ///< camera in the body (IMU) frame
  double camera_rate_hz = 20;
  double line_delay_s = 0;  ///< rolling shutter: from row to row; a frame's time is that of the middle row
  ImuNoise imu_noise;
  AxesErrors axes;  ///< recordings hand on samples that are corrected for them
  double imu_rate_hz = 200;
  double gravity_m_s2 = kGravity;         ///< where the recording was made
  std::shared_ptr<const GrayImage> mask;  ///< of the camera's size, black where images are not used; null: nowhere

  double readout_s() const { return line_delay_s * camera.height; }  ///< of an image: from its first to its last row
};

}  // namespace lintel
