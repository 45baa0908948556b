// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapStructure.h"

#include "CornerFinding.h"
#include "NeighbourLines.h"
#include "PlaneFinding.h"

namespace lintel {

void findStructure(LineMap& map) {
  map.corners.clear();
  map.planes.clear();
  std::vector<SpatialLine> lines;
  for (const MapLine& line : map.lines) lines.emplace_back(line);
  const std::vector<LineNeighbours> neighbours = neighboursOf(lines);
  map.corners = findCorners(map, lines, neighbours);
  map.planes = findPlanes(map, lines, neighbours);
}

}  // namespace lintel
