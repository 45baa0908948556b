// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapStructure.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "CornerFinding.h"
#include "NeighbourLines.h"
#include "PlaneFinding.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

constexpr double kNearest_m = 2, kFarthest_m = 8;  // the lines of rooms and halls are seen from between these, median

/// How large the place is against rooms and halls, for whose corners and planes all lengths of the search are made: by
/// the distances from which its lines were seen.
double sizeOf(const LineMap& map) {
  std::unordered_map<std::uint64_t, Eigen::Vector3d> cameras;
  for (const MapKeyframe& keyframe : map.keyframes) cameras.emplace(keyframe.id, keyframe.T_w_b.p);
  std::vector<double> distances_m;
  for (const MapLine& line : map.lines) {
    if (line.observations.empty()) continue;
    const auto camera = cameras.find(line.observations[line.observations.size() / 2].keyframe_id);
    if (camera != cameras.end()) distances_m.push_back((line.segment_w.midpoint() - camera->second).norm());
  }
  const double usual_m = distances_m.empty() ? 0 : upperMedian(distances_m);
  if (!(usual_m > 0 && std::isfinite(usual_m))) return 1;
  return usual_m / std::clamp(usual_m, kNearest_m, kFarthest_m);
}

/// What corners and planes are found from, as large as in a room.
LineMap asInARoom(const LineMap& map, double size) {
  LineMap result;
  for (const MapKeyframe& keyframe : map.keyframes) {
    result.keyframes.emplace_back();
    result.keyframes.back().T_w_b.p = keyframe.T_w_b.p / size;
  }
  for (const MapPoint& point : map.points) {
    result.points.emplace_back();
    result.points.back().id = point.id;
    result.points.back().p_w = point.p_w / size;
    result.points.back().sigma_distance_m = point.sigma_distance_m / size;
  }
  const Eigen::Vector4f scale(1 / static_cast<float>(size), 1 / static_cast<float>(size), 1, 1);
  for (const MapLine& line : map.lines) {
    result.lines.emplace_back();
    MapLine& copy = result.lines.back();
    copy.id = line.id;
    copy.segment_w = {line.segment_w.start / size, line.segment_w.end / size};
    copy.sigma_direction_rad = line.sigma_direction_rad;
    copy.sigma_distance_m = line.sigma_distance_m / size;
    copy.covariance = scale.asDiagonal() * line.covariance * scale.asDiagonal();
  }
  return result;
}

}  // namespace

void findStructure(LineMap& map) {
  const double size = sizeOf(map);
  const LineMap room = asInARoom(map, size);
  std::vector<SpatialLine> lines;
  for (const MapLine& line : room.lines) lines.emplace_back(line);
  const std::vector<LineNeighbours> neighbours = neighboursOf(lines);
  map.corners = findCorners(room, lines, neighbours);
  for (MapCorner& corner : map.corners) corner.p_w *= size, corner.sigma_m *= size;
  map.planes = findPlanes(room, lines, neighbours);
  for (MapPlane& plane : map.planes) plane.offset_m *= size, plane.spread_m *= size;
}

}  // namespace lintel
