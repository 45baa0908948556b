// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Finds groups of parallel lines (vanishing directions, in a Manhattan world or not), the longest in sum first, names
/// them and sets `group` of every line.
std::vector<MapGroup> findGroups(const GroupParams& params, std::vector<MapLine>& lines);

}  // namespace lintel
