// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/estimator/WindowUpdate.h"
#include "lintel/mapping/MapPieces.h"

namespace lintel {

/// How far keyframes are from where they were. The place and yaw of each world are not observable: what all its
/// keyframes have in common of these is no change.
struct TrajectoryChange {
  double moved_m = 0, turned_rad = 0;  ///< most, of a keyframe
  double travelled_m = 0;              ///< the way before
};

/// `before`, `after`: the same keyframes; `pieces` of them, empty: one world.
TrajectoryChange trajectoryChange(const std::vector<RetiredKeyframe>& before, const std::vector<RetiredKeyframe>& after,
                                  const std::vector<MapPiece>& pieces);

}  // namespace lintel
