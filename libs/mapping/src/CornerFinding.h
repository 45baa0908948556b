// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NeighbourLines.h"

namespace lintel {

/// Where lines meet. Two lines do when they come as near to each other as their covariances allow, at a place that both
/// reach and where one of them at least ends; further ones when the place that all determine agrees with each of them.
std::vector<MapCorner> findCorners(const LineMap& map, const std::vector<SpatialLine>& lines,
                                   const std::vector<LineNeighbours>& neighbours);

}  // namespace lintel
