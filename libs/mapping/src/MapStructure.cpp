// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapStructure.h"

#include <algorithm>
#include <unordered_map>

#include "CornerFinding.h"
#include "NeighbourLines.h"
#include "PlaneFinding.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

constexpr double kRoom_m = 8;  // nearer than that half of the lines are in rooms and halls

/// By how much the place is larger than rooms and halls, whose corners and planes all lengths of the search are made
/// for: from the distances in which its lines were seen.
double sizeOf(const LineMap& map) {
  std::unordered_map<std::uint64_t, Eigen::Vector3d> cameras;
  for (const MapKeyframe& keyframe : map.keyframes) cameras.emplace(keyframe.id, keyframe.T_w_b.p);
  std::vector<double> distances_m;
  for (const MapLine& line : map.lines) {
    if (line.observations.empty()) continue;
    const auto camera = cameras.find(line.observations[line.observations.size() / 2].keyframe_id);
    if (camera != cameras.end()) distances_m.push_back((line.segment_w.midpoint() - camera->second).norm());
  }
  return distances_m.empty() ? 1 : std::max(1.0, upperMedian(distances_m) / kRoom_m);
}

/// What corners and planes are found from, `size` times smaller.
LineMap madeSmaller(const LineMap& map, double size) {
  LineMap smaller;
  for (const MapKeyframe& keyframe : map.keyframes) {
    smaller.keyframes.emplace_back();
    smaller.keyframes.back().T_w_b.p = keyframe.T_w_b.p / size;
  }
  for (const MapPoint& point : map.points) {
    smaller.points.emplace_back();
    smaller.points.back().id = point.id;
    smaller.points.back().p_w = point.p_w / size;
    smaller.points.back().sigma_distance_m = point.sigma_distance_m / size;
  }
  const Eigen::Vector4f scale(1 / static_cast<float>(size), 1 / static_cast<float>(size), 1, 1);
  for (const MapLine& line : map.lines) {
    smaller.lines.emplace_back();
    MapLine& copy = smaller.lines.back();
    copy.id = line.id;
    copy.segment_w = {line.segment_w.start / size, line.segment_w.end / size};
    copy.sigma_direction_rad = line.sigma_direction_rad;
    copy.sigma_distance_m = line.sigma_distance_m / size;
    copy.covariance = scale.asDiagonal() * line.covariance * scale.asDiagonal();
  }
  return smaller;
}

}  // namespace

void findStructure(LineMap& map) {
  const double size = sizeOf(map);
  const LineMap smaller = madeSmaller(map, size);
  std::vector<SpatialLine> lines;
  for (const MapLine& line : smaller.lines) lines.emplace_back(line);
  const std::vector<LineNeighbours> neighbours = neighboursOf(lines);
  map.corners = findCorners(smaller, lines, neighbours);
  for (MapCorner& corner : map.corners) corner.p_w *= size, corner.sigma_m *= size;
  map.planes = findPlanes(smaller, lines, neighbours);
  for (MapPlane& plane : map.planes) plane.offset_m *= size, plane.spread_m *= size;
}

}  // namespace lintel
