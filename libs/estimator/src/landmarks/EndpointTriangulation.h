// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "landmarks/CameraPoses.h"

namespace lintel {

enum class EndsVerdict {
  kNoCorners,  ///< an end lies at the image's border or is not stable (occlusion, fragmentation)
  kTooEarly,   ///< the ends look fixed, but have no parallax yet
  kCorners,
};

/// A segment in the world from its end points, as far as these are real corners.
struct SeenEnds {
  EndsVerdict verdict = EndsVerdict::kNoCorners;
  Eigen::Vector3d start_w = Eigen::Vector3d::Zero(),
                  end_w = Eigen::Vector3d::Zero();  ///< kCorners only, as what follows
  double sigma_direction_rad = 0;
  double sigma_distance_m = 0;  ///< of the middle
};

/// Triangulates both end points of a track as points: what moves along a line shows its depth.
SeenEnds triangulateEnds(const CameraPoses& poses, const LineTrack& track);

}  // namespace lintel
