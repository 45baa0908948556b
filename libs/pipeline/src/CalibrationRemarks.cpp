// SPDX-License-Identifier: BSD-3-Clause
#include "CalibrationRemarks.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

// Rolling shutters take 5 to 30 ms for an image. What is found with a global shutter is the sum of all that the model
// leaves out, a fraction of a millisecond.
constexpr double kShortest_s = 0.002, kLargestShare = 0.1, kSigmas = 5;
constexpr double kMostOfSensors = 0.1;  // twice what the axes of a depth camera (L515) are wrong by

std::string axesRemark(const std::string& sensor, const std::string& askew, const Eigen::Matrix3d& given,
                       const Eigen::Matrix3d& found, double least) {
  const double wrong = (found - given).cwiseAbs().maxCoeff();
  if (!(wrong > least)) return {};
  if (wrong > kMostOfSensors) {
    return formatted(
        "the %s's samples fit the images only with axes that are wrong by up to %.0f %%, more than those of "
        "any working sensor: its bias may change fast (warming up), or what it is fixed to vibrates or bends",
        sensor.c_str(), 100 * wrong);
  }
  return formatted(
      "the %s's axes are wrong by up to %.1f %% (%s, or of wrong scale); corrected on the way, better give "
      "`%s_axes: [%.4f, %.4f, %.4f, %.4f, %.4f, %.4f, %.4f, %.4f, %.4f]` beside the IMU's noise densities: "
      "then they are right from the start",
      sensor.c_str(), 100 * wrong, askew.c_str(), sensor.c_str(), found(0, 0), found(0, 1), found(0, 2), found(1, 0),
      found(1, 1), found(1, 2), found(2, 0), found(2, 1), found(2, 2));
}

}  // namespace

std::string readoutRemark(const Rig& given, const CalibrationEstimate& estimate) {
  if (!estimate.sigma || given.camera.height <= 0) return {};
  const double wrong_s = estimate.readout_s - given.readout_s();
  const double least_s =
      std::max({kShortest_s, kSigmas * estimate.sigma->readout_s, kLargestShare * std::abs(given.readout_s())});
  if (!(std::abs(wrong_s) > least_s)) return {};
  const std::string shutter = given.line_delay_s == 0 ? "the calibration says nothing of a rolling shutter, but"
                                                      : "the calibration's readout of the rolling shutter is wrong:";
  return formatted(
      "%s the rows were exposed one after the other, %.1f ms from the first to the last (sigma %.2f ms); "
      "corrected on the way, better give `line_delay_s: %.3g` in the camera's calibration, where a stamp is "
      "that of the middle row",
      shutter.c_str(), 1000 * estimate.readout_s, 1000 * estimate.sigma->readout_s,
      estimate.readout_s / given.camera.height);
}

std::string accelerometerAxesRemark(const AxesErrors& given, const Eigen::Matrix3d& A) {
  constexpr double kLeast = 0.02;  // four standard deviations of a direction, of a calibrated sensor's prior
  return axesRemark("accelerometer", "not square to each other or to the gyroscope's", given.A, A, kLeast);
}

std::string gyroscopeAxesRemark(const AxesErrors& given, const Eigen::Matrix3d& G) {
  constexpr double kLeast = 0.01;  // ten standard deviations of a calibrated sensor's prior
  return axesRemark("gyroscope", "not square to each other", given.G, G, kLeast);
}

std::string stampRemark(const CalibrationEstimate& estimate) {
  if (!(estimate.stamp_jitter_s > 0)) return {};
  return formatted(
      "the images' stamps are off by %.1f ms (standard deviation), each by its own amount, as when they say "
      "when an image came in; the IMU counts less for that, and with the camera's own stamps the result "
      "would be better",
      1000 * estimate.stamp_jitter_s);
}

}  // namespace lintel
