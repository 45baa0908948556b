// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// Turns the planes' normals towards the cameras, and names them: the floor, the ceiling and walls are large and have
/// nothing of the map behind them. Pieces of one wall become one plane.
void namePlanes(const LineMap& map, std::vector<MapPlane>& planes);

}  // namespace lintel
