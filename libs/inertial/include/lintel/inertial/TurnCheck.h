// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "lintel/core/CameraTurn.h"
#include "lintel/core/Frame.h"

namespace lintel {

/// The turns that images show as a linear function of those that the gyroscope shows, both in the axes of the camera as
/// calibrated: turn = M * gyro + bias * dt. With a good calibration M is the identity. A camera that is mounted
/// otherwise makes it a rotation, mirrored images or interchanged axes one of determinant -1, a wrong unit or focal
/// length a scale.
struct TurnFit {
  double offset_s = 0;  ///< an image with stamp t shows the world at t + offset of the IMU's clock
  int compared = 0;     ///< visible turns, axis by axis: beyond four standard deviations, and lasting
  double missed = 1;    ///< median share of a visible turn that is left open
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d sigma = Eigen::Matrix3d::Zero();  ///< standard deviations of M's entries
};

/// What else speaks against a run.
enum class Suspicion {
  kNone,  ///< nothing: only what no run survives is a fault
  kSome,  ///< the run has failed: smaller contradictions may be why
};

class GyroPath;

/// Compares how the camera turns with how the gyroscope turns. The images' turns must not depend on the gyroscope.
class TurnCheck {
 public:
  explicit TurnCheck(const Eigen::Quaterniond& R_b_c) : R_b_c_(R_b_c) {}

  /// A frame's IMU since the frame before (core/Frame.h), and how the camera turned meanwhile, if that is known.
  void add(const ImuBatch& imu, const CameraTurn& turn);

  TurnFit fit(double offset_s = 0) const;

  /// At the offset of the clocks, up to ten seconds, at which least is missed.
  TurnFit bestFit() const;

  /// Whether the camera has turned enough to tell, and the gyroscope shows it as the calibration says.
  bool agree() const;

  /// What is wrong, in words, with the likely cause; empty when nothing is, or nothing can be said. `corrected_s`: by
  /// which offset of the clocks the stamps have been corrected already.
  std::string fault(Suspicion suspicion, double corrected_s = 0) const;

 private:
  bool gyroIsSilent() const;
  TurnFit fitAlong(const GyroPath& path, double offset_s) const;

  Eigen::Quaterniond R_b_c_;
  ImuBatch imu_;
  std::vector<CameraTurn> turns_;
  int visible_ = 0;
};

}  // namespace lintel
