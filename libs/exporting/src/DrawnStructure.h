// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// The corners and planes of lines that are drawn; they name no others.
struct DrawnStructure {
  std::vector<MapCorner> corners;  ///< of two lines at least
  std::vector<MapPlane> planes;    ///< of one line at least, with the points that are drawn
};

/// `lines` and `points` are drawn, ascending by id.
DrawnStructure drawnStructure(const LineMap& map, const std::vector<const MapLine*>& lines,
                              const std::vector<const MapPoint*>& points);

}  // namespace lintel
