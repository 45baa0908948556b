// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/SecondTry.h"

#include <algorithm>

#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr double kEnough = 0.5;       // of the frames with a pose
constexpr double kOften = 0.25;       // of the frames that wait for a start, those that wait for the scale
constexpr double kScaleSigma = 0.15;  // of a start

}  // namespace

bool mayHaveWrongClock(const OdometryResult& result) {
  return !result.cancelled && result.error.empty() && result.clock_offset_s != 0 &&
         result.statistics.frames_with_pose == 0;
}

Configuration asStamped(Configuration configuration) {
  configuration.estimator.calibration.find_clock_offset = false;
  return configuration;
}

bool hasPoses(const OdometryResult& second, const OdometryResult& /*first*/) {
  return !second.cancelled && second.statistics.frames_with_pose > 0;
}

bool lacksScale(const OdometryResult& result) {
  const OdometryStatistics& s = result.statistics;
  return !result.cancelled && result.error.empty() && s.frames_without_scale > 0 &&
         static_cast<double>(s.frames_with_pose) < kEnough * static_cast<double>(s.frames) &&
         static_cast<double>(s.frames_without_scale) >= kOften * static_cast<double>(s.frames_waiting);
}

Configuration secondTryOf(Configuration configuration) {
  double& sigma = configuration.estimator.initializer.max_scale_sigma;
  sigma = std::max(sigma, kScaleSigma);
  return configuration;
}

bool isBetter(const OdometryResult& second, const OdometryResult& first) {
  return !second.cancelled && second.verdict.empty() && second.refinement.accepted &&
         second.refined_trajectory.size() > std::max(first.trajectory.size(), first.refined_trajectory.size());
}

std::string verdictOfSecondTry(const OdometryResult& second) {
  return formatted(
      "the motion hardly shows the scale: the refined trajectory and the map may be several per cent too "
      "large or too small (%.1f %% by their residuals), the causal trajectory more; start where it moves more "
      "strongly (--from)",
      100 * second.refinement.scale_sigma);
}

}  // namespace lintel
