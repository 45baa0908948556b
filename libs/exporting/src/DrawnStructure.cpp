// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnStructure.h"

#include <algorithm>
#include <iterator>

namespace lintel {

namespace {

using Ids = std::vector<std::uint64_t>;

template <class Thing>
Ids idsOf(const std::vector<const Thing*>& things) {
  Ids ids;
  for (const Thing* thing : things) ids.push_back(thing->id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

Ids common(const Ids& of_one, const Ids& drawn) {
  Ids ids;
  std::copy_if(of_one.begin(), of_one.end(), std::back_inserter(ids),
               [&](std::uint64_t id) { return std::binary_search(drawn.begin(), drawn.end(), id); });
  return ids;
}

}  // namespace

DrawnStructure drawnStructure(const LineMap& map, const std::vector<const MapLine*>& lines,
                              const std::vector<const MapPoint*>& points) {
  const Ids line_ids = idsOf(lines), point_ids = idsOf(points);
  DrawnStructure drawn;
  for (MapCorner corner : map.corners) {
    corner.lines = common(corner.lines, line_ids);
    if (corner.lines.size() >= 2 && corner.p_w.allFinite()) drawn.corners.push_back(std::move(corner));
  }
  for (MapPlane plane : map.planes) {
    plane.lines = common(plane.lines, line_ids), plane.points = common(plane.points, point_ids);
    if (!plane.lines.empty()) drawn.planes.push_back(std::move(plane));
  }
  return drawn;
}

}  // namespace lintel
