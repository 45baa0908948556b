// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/geometry/EulerAngles.h"

namespace lintel {

/// Reads trajectory_covariance.csv: a row for each pose, the time [s] and 21 numbers, the upper triangle by rows of the
/// covariance in (x, y, z, yaw, pitch, roll), or all 36 of it. Gives them in (p, theta) as in EulerAngles.h.
/// Throws EvaluationError when a row is malformed or is not that of its pose.
std::vector<PoseCovariance> readCovariances(const std::string& path, const StampedPoses& poses);

/// Squared errors in units of their covariance (NEES [BarShalom2001]).
struct SquaredErrorSummary {
  int freedom = 1;           ///< what they are on average where the covariance is right
  double mean = 0;           ///< of all poses
  double low = 0, high = 0;  ///< one pose's lies between in 95 of 100 cases (chi-square)
  double inside = 0;         ///< share of the poses between the two
};

/// Errors and standard deviations of a pose along the axes of the estimate's world.
struct SigmaSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d error_m, sigma_m;
};

/// Whether a trajectory's covariances are true. They are relative to the first pose, so the estimate is laid on the
/// truth by position and yaw there; anew in each piece: a row whose position has no variance begins one. The truth is
/// interpolated to the estimate's times.
struct Consistency {
  std::size_t poses = 0, pieces = 0;
  SquaredErrorSummary position, yaw, roll_pitch;
  std::vector<SigmaSample> series;
};

/// Throws EvaluationError when no pose has a covariance and a true partner.
Consistency evaluateConsistency(const StampedPoses& estimate, const std::vector<PoseCovariance>& covariances,
                                const StampedPoses& groundtruth, const TrajectoryErrorParams& params = {});

}  // namespace lintel
