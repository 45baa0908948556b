// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// A known point and the direction in which the camera may see it.
struct Sighting {
  Eigen::Vector3d p_w;
  Eigen::Vector3d bearing_c;  ///< unit
};

struct ResectionParams {
  int hypotheses = 400;
  double coarse_rad = 0.013;  ///< of sightings that agree with two others, which know the tilt only as the window did
  double fine_rad = 0.0065;   ///< of those that agree with all
};

struct Resection {
  Pose T_w_c;
  std::vector<std::size_t> inliers;  ///< places in the sightings
};

/// Where a camera is that sees known points, many of which may be wrong. Its roll and pitch in `R_w_c`, those of a
/// visual-inertial odometry, are nearly right and begin it; its yaw and its place are not used. RANSAC over pairs of
/// sightings (absolute pose from two points and the vertical, [Kukelova2010]), then least squares with all that agree,
/// in all six unknowns. Empty when fewer than four agree. Deterministic.
std::optional<Resection> resect(const std::vector<Sighting>& sightings, const Eigen::Quaterniond& R_w_c,
                                const ResectionParams& params);

}  // namespace lintel
