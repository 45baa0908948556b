// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lintel/estimator/EstimatorParams.h"

namespace lintel::test {

/// A squared error in units of its estimated covariance (NEES), and its degrees of freedom: what it is on average where
/// the covariance is right.
struct SquaredError {
  double value = 0;
  int freedom = 1;
};
using SquaredErrors = std::map<std::string, SquaredError>;

struct ConsistencySetting {
  double duration_s = 30;
  int points = 80, lines = 25;         ///< tracked in each image
  std::vector<double> times_s{6, 30};  ///< after the first frame: when errors are taken
  bool plain = false;                  ///< residuals without robust losses
  bool imu_as_given = false;           ///< the IMU's noise is not measured anew
};

struct ConsistencyFlight {
  double rmse_m = -1;  ///< of the causal trajectory, after alignment of position and yaw; negative: there is none
  int lost = 0;
  std::map<double, SquaredErrors> at;        ///< by time
  std::vector<SquaredErrors> points, lines;  ///< of all that were handed over, seen from their first keyframe
};

/// The estimator on a simulated flight with white noise and an exact model. The seed draws motion, landmarks, noise,
/// and from their priors the calibration with the time offset.
ConsistencyFlight flyConsistently(std::uint64_t seed, const ConsistencySetting& setting);

/// Between which the mean of `count` independent squared errors lies in 95 of 100 cases, if the covariances are right
/// (chi-square, by [Wilson1931]).
std::pair<double, double> boundsOfMean(std::size_t count, int freedom);

}  // namespace lintel::test
