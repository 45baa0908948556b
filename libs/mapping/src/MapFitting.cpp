// SPDX-License-Identifier: BSD-3-Clause
#include "MapFitting.h"

#include "LineGroups.h"
#include "LineSplitting.h"
#include "LineTying.h"
#include "PointJoining.h"
#include "PointMerging.h"
#include "lintel/mapping/MapBuilder.h"

namespace lintel {

MapFitting::MapFitting(const MapParams& params, MapMaterial& material)
    : params_(params), material_(material), cameras_(material) {
  line_.max_error_px = point_.max_error_px = params.view_max_error_px;
  line_.min_depth_m = point_.min_depth_m = params.min_depth_m;
}

void MapFitting::fitAll() {
  for (PointRecord& point : material_.points) fitPoint(cameras_, point_, point);
  for (LineRecord& line : material_.lines) fitLine(cameras_, line_, line);
  if (splitLines(material_.lines) == 0) return;
  for (LineRecord& line : material_.lines) fitLine(cameras_, line_, line);
}

int MapFitting::merge(const MergeAllowance& allowance) {
  int merged = 0;
  if (params_.merge.points) merged += mergePoints(cameras_, point_, params_.merge, material_.points);
  if (params_.merge.lines) merged += mergeLines(allowance);
  return merged;
}

int MapFitting::mergeLines(const MergeAllowance& allowance) {
  return lintel::mergeLines(cameras_, line_, params_.merge, allowance, material_.lines);
}

int MapFitting::join(const std::vector<PointJoin>& joins, double most_px, double sigma_px) {
  return joinPoints(cameras_, point_, joins, most_px, sigma_px, material_.points);
}

std::vector<MapGroup> MapFitting::groups() const {
  const LineMap map = drawMap(params_, material_);
  const std::vector<bool> certain = certainGroups(map);
  std::vector<MapGroup> groups;
  for (std::size_t g = 0; g < certain.size(); ++g)
    if (certain[g]) groups.push_back(map.groups[g]);
  return groups;
}

void MapFitting::tie() {
  if (tieDegenerateLines(cameras_, line_, params_, groups(), material_) > 0 && params_.merge.lines) mergeLines();
}

void MapFitting::align() { alignToGroups(cameras_, line_, params_, groups(), material_); }

}  // namespace lintel
