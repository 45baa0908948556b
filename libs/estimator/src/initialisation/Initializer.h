// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// The reason of a start that is refused for its accelerometer bias.
inline constexpr char kBiasImplausible[] = "the accelerometer bias of the start is implausible";

/// Turns a buffer of frames without states into a window. Moving start: gyro bias from epipolar geometry
/// (GyroAlignment), velocity and gravity in closed form (GravityAlignment), full adjustment, and a check of what came
/// out, its scale included. Static start: gravity from the accelerometer, bias from the gyroscope.
class Initializer {
 public:
  Initializer(const EstimatorParams& params, const Pose& T_b_c_calibrated)
      : params_(paramsAtStart(params)), T_b_c_calibrated_(T_b_c_calibrated) {}

  /// Tries on all frames of `window`. On success its states, points and priors are set (first frame at the origin,
  /// yaw 0) and the result is empty; else the window is unchanged in frames and tracks, and the result says in words
  /// what is waited for (kScaleUnknown where it is only the scale, kBiasImplausible).
  std::string initialise(SlidingWindow& window) const;

  /// Accelerometer bias that a start must not have, and not come to while it is on trial [m/s^2]: four standard
  /// deviations of what is known of it beforehand. A wrong gyro bias or scale shows here first.
  double mostBiasAccel() const { return 4 * params_.initializer.bias_accel_sigma; }

  /// Further starts take the accelerometer for one whose bias is less known (`late_bias_accel_sigma`).
  void expectLargerBias();

  /// True when points and IMU say that nothing moves over the whole buffer.
  bool atRest(const SlidingWindow& window) const;

 private:
  static EstimatorParams paramsAtStart(EstimatorParams params);
  std::string startStatic(SlidingWindow& window) const;
  std::string startMoving(SlidingWindow& window) const;
  std::string tryMoving(const Eigen::Vector3d& bias_gyro, SlidingWindow& trial) const;
  double misfitOf(SlidingWindow& window) const;  ///< squared residuals, in sigmas, of points, IMU and priors
  /// Whether an adjustment is left as soon as the scale turns out to be far from known.
  enum class Gates { kNone, kHopeless };
  bool adjust(const CalibrationParams& calibration, Gates gates, SlidingWindow& window) const;
  bool isFull(const SlidingWindow& window) const;
  /// What is refined of `calibration` in a start. A second or two of strong motion hardly show the calibration, nor do
  /// its errors matter; a full buffer means gentle motion, where they are taken for accelerations.
  CalibrationParams refinedIn(const SlidingWindow& window, CalibrationParams calibration) const;
  /// With k1 and k2 free as well, where they are not given and that fits clearly better.
  bool adjustWithLens(Gates gates, SlidingWindow& trial) const;
  void tryOtherScales(SlidingWindow& best) const;
  std::vector<double> errorsPx(const SlidingWindow& window, int& candidates) const;
  bool distortionUnknown() const;
  double scaleSigmaFor(const SlidingWindow& window) const;      ///< relative, that is asked for
  bool scaleWithin(double times, SlidingWindow& window) const;  ///< times the sigma that is asked for
  std::string verify(SlidingWindow& window) const;
  double relativeScaleSigma(SlidingWindow& window) const;
  void setBiasPrior(SlidingWindow& window, const MotionBlock& mean, double gyro_sigma, double velocity_sigma) const;
  void levelAndCentre(SlidingWindow& window) const;

  EstimatorParams params_;
  Pose T_b_c_calibrated_;
};

/// Median motion of points between two frames of the window in pixels; `rotation_free` takes the gyro's rotation out.
/// Negative when fewer than ten points are seen by both.
double medianDisparityPx(const SlidingWindow& window, std::size_t frame_a, std::size_t frame_b, bool rotation_free);

}  // namespace lintel
