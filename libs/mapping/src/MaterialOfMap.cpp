// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/ImagePoses.h"
#include "lintel/mapping/LineFitting.h"
#include "lintel/mapping/MapBuilder.h"

namespace lintel {

namespace {

constexpr float kViewSigma_px = 0.3f;  // of edges that were followed; a map does not keep it

}  // namespace

MapMaterial materialOf(const MapParams& params, const LineMap& map) {
  MapMaterial material;
  material.rig = map.rig;
  material.time_offset_s = map.time_offset_s;
  material.pieces = map.pieces;
  material.camera_errors = map.camera_errors;
  material.keyframes = retiredKeyframes(map);
  material.trajectory = posesOfStates(material, map.trajectory);
  for (const MapPoint& point : map.points) {
    PointRecord record;
    record.id = record.track = point.id, record.known = true;
    record.p_w = point.p_w, record.sigma_distance_m = point.sigma_distance_m;
    for (const MapPointObservation& seen : point.observations)
      record.views.push_back({static_cast<std::uint32_t>(seen.keyframe_id), seen.px.cast<float>(), true});
    material.points.push_back(std::move(record));
  }
  const KeyframeCameras cameras(material);
  LineFitParams fit;
  fit.max_error_px = params.view_max_error_px;
  fit.min_depth_m = params.min_depth_m;
  for (const MapLine& line : map.lines) {
    LineRecord record;
    record.id = line.id, record.known = true, record.parallel = line.constrained, record.mapped = line.mapped;
    record.estimate.middle_w = line.segment_w.midpoint();
    record.estimate.direction_w = line.segment_w.direction();
    for (const MapLineObservation& seen : line.observations)
      record.views.push_back(
          {seen.keyframe_id, line.id, seen.start_px.cast<float>(), seen.end_px.cast<float>(), kViewSigma_px, true});
    if (line.constrained && line.group >= 0 && static_cast<std::size_t>(line.group) < map.groups.size()) {
      const MapGroup& group = map.groups[static_cast<std::size_t>(line.group)];
      record.tie = LineTie{group.direction_w, std::max(group.spread_rad, line.sigma_direction_rad), {}};
    }
    fitLine(cameras, fit, record);
    material.lines.push_back(std::move(record));
  }
  return material;
}

}  // namespace lintel
