// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Pose.h"

namespace lintel {

/// Checks the accelerometer's unit and axes by its values, independently of the estimator.
///
/// Size: over a second, a body that is carried or flies changes its speed little: the mean specific force is gravity's.
/// Axes: turned by the gyroscope into the axes of the start of some seconds, gravity is constant. If the axes
/// of the accelerometer are not the gyroscope's, it varies; the interchange of axes and signs with which it varies
/// least is the likely one. (All three signs together make no difference here.)
class AccelerometerCheck {
 public:
  /// `gravity_m_s2`: where the samples were taken.
  explicit AccelerometerCheck(double gravity_m_s2 = kGravity);

  /// Samples between two frames (core/Frame.h), ascending; `bias_gyro` as far as it is known.
  void add(const ImuBatch& batch, const Eigen::Vector3d& bias_gyro);

  /// Median of the size of a second's mean specific force [m/s^2]; 0 before the first second is over.
  double gravity() const;

  /// What is wrong with the size, in words; empty when it can be gravity. Values that never change while the IMU turns
  /// count as well.
  std::string sizeFault() const;

  /// By how much gravity wanders when the gyroscope turns it, squared, as a multiple of what it does with the axes that
  /// suit best; 1 when these are the axes as they are, or nothing can be said.
  double axesMisfit() const;

  /// Which axes are likely interchanged, in words; empty when they fit best as they are, or nothing can be said.
  std::string axesFault() const;

 private:
  void closeMean();
  void closeSpan();

  double gravity_m_s2_;
  std::int64_t last_ns_ = 0, mean_start_ns_ = 0, span_start_ns_ = 0;
  Eigen::Quaterniond R_ = Eigen::Quaterniond::Identity();  ///< body axes now, in those of the span's start
  Eigen::Matrix<double, 9, 3> sum_ = Eigen::Matrix<double, 9, 3>::Zero();  ///< of R's columns by accelerations
  int count_ = 0;
  std::vector<Eigen::Matrix<double, 9, 3>> means_;  ///< of the span
  std::vector<double> sizes_, span_sizes_;          ///< of means over a second, over five
  Eigen::Vector3d lowest_ = Eigen::Vector3d::Constant(1e9), highest_ = Eigen::Vector3d::Constant(-1e9);
  double turned_rad_ = 0;        ///< summed over all samples
  std::vector<double> misfits_;  ///< by axes assignment: summed squared deviations from a span's mean
  int compared_ = 0;
};

}  // namespace lintel
