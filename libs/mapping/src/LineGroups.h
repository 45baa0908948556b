// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Finds groups of parallel lines (vanishing directions, in a Manhattan world or not), the longest in sum first, names
/// them and sets `group` of every line.
std::vector<MapGroup> findGroups(const GroupParams& params, std::vector<MapLine>& lines);

/// How parallel a group is, as a standard deviation: its spread, or a lower limit, since the spread of a few members
/// may be smaller than that of the group.
double sigmaOf(const MapGroup& group);

/// Whether each group of a map is one of the scene: a tenth of the map's length at least. Among lines of all directions
/// random groups reach a twentieth (measured: a scene of struts).
std::vector<bool> certainGroups(const LineMap& map);

}  // namespace lintel
