// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/WindowUpdate.h"
#include "lintel/sensing/Frame.h"
#include "lintel/sensing/Rig.h"
#include "lintel/tracking/FrameTracks.h"

namespace lintel {

/// Calibration as refined so far, with standard deviations where it is refined.
struct CalibrationEstimate {
  PinholeRadtan camera;
  Pose T_b_c;
  double time_offset_s = 0;  ///< an image with stamp t shows the world at t + offset
};

/// Point-line visual-inertial odometry in a sliding window [Qin2018, Lim2021]: tracks and IMU in, poses and retired
/// landmarks out. Only sequences: initialisation, triangulation, adjustment, outliers, failure, marginalisation.
/// Deterministic.
class Estimator {
 public:
  /// Throws std::invalid_argument, naming the parameter, when one is out of range.
  Estimator(const Rig& rig, const EstimatorParams& params);
  ~Estimator();
  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;

  /// One frame's tracks and the IMU since the frame before (both ends included, see sensing/Frame.h).
  WindowUpdate process(const FrameTracks& tracks, const ImuBatch& imu);

  /// Retires everything that is still in the window. The estimator starts anew with the next frame.
  WindowUpdate finish();

  CalibrationEstimate calibration() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
