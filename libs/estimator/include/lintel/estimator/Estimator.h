// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"
#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

/// Standard deviations of a calibration; zero for what is held.
struct CalibrationSigma {
  Eigen::Vector3d p_b_c_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d R_b_c_rad = Eigen::Vector3d::Zero();                       ///< about the camera's axes
  Eigen::Matrix<double, 6, 1> camera = Eigen::Matrix<double, 6, 1>::Zero();  ///< fx fy cx cy [px], k1 k2
  double time_offset_s = 0, readout_s = 0;
  Eigen::Matrix3d accelerometer_axes = Eigen::Matrix3d::Zero(), gyroscope_axes = Eigen::Matrix3d::Zero();
  /// Of all of it: T_b_c in the tangent space of a pose block, then the correction (StateBlocks.h).
  Eigen::Matrix<double, 14, 14> covariance = Eigen::Matrix<double, 14, 14>::Zero();
};

/// Calibration as refined so far.
struct CalibrationEstimate {
  Camera camera;
  Pose T_b_c;
  double time_offset_s = 0;   ///< an image with stamp t shows the world at t + offset
  double readout_s = 0;       ///< of a rolling shutter: from an image's first row to its last
  double stamp_jitter_s = 0;  ///< standard deviation of the images' stamps; 0 where it does not matter
  Eigen::Matrix3d accelerometer_axes = Eigen::Matrix3d::Zero();  ///< A of Rig::axes, as it should be
  Eigen::Matrix3d gyroscope_axes = Eigen::Matrix3d::Zero();      ///< G of Rig::axes, as it should be
  std::optional<CalibrationSigma> sigma;                         ///< of the last window; empty while there is none
};

/// Point-line visual-inertial odometry in a sliding window [Qin2018, Lim2021]: tracks and IMU in, poses and retired
/// landmarks out. Calls the steps in order: initialisation, triangulation, adjustment, outliers, failure,
/// marginalisation. Deterministic.
class Estimator {
 public:
  /// Throws std::invalid_argument, naming the parameter, when one is out of range.
  Estimator(const Rig& rig, const EstimatorParams& params);
  ~Estimator();
  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;

  /// One frame's tracks and the IMU since the frame before (both ends included, see core/Frame.h).
  WindowUpdate process(const FrameTracks& tracks, const ImuBatch& imu);

  /// Retires everything that is still in the window. The estimator starts anew with the next frame.
  WindowUpdate finish();

  CalibrationEstimate calibration() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
