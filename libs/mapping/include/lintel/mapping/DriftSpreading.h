// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// A frame that shows a place seen before: where the odometry has its camera, and where the points of the earlier visit
/// say that it is.
struct PlaceSighting {
  std::int64_t earlier_ns = 0, later_ns = 0;
  Pose T_w_c0;  ///< by the odometry
  Pose T_w_c1;  ///< by the place, in the world as it was at the earlier time
};

/// Before an adjustment that begins with the odometry's poses: when one sighting in ten contradicts them by more than
/// 0.1 m or 1.7 degrees, spreads the difference over the way between, most over stretches in which nothing was seen.
/// A pose graph of yaw and position, the vertical is known; sightings that contradict the others count little in the
/// end (graduated non-convexity, [Yang2020]). The first keyframe of each world stays. Points and lines move with the
/// keyframe that saw them first. Returns false when nothing was done.
bool spreadDrift(const std::vector<PlaceSighting>& sightings, MapMaterial& material);

}  // namespace lintel
