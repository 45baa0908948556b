// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "NeighbourLines.h"

namespace lintel {

/// Planes that hold at least three lines of different directions which are connected by neighbours, with the points
/// near these lines.
std::vector<MapPlane> findPlanes(const LineMap& map, const std::vector<SpatialLine>& lines,
                                 const std::vector<LineNeighbours>& neighbours);

}  // namespace lintel
