// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapBuilder.h"

#include <algorithm>

#include "MapFitting.h"
#include "StartPoses.h"

namespace lintel {

namespace {

PointRecord recordOf(const RetiredPoint& retired) {
  PointRecord point;
  point.id = point.track = retired.id;
  point.known = retired.triangulated;
  point.p_w = retired.p_w;
  point.sigma_distance_m = retired.sigma_distance_m;
  point.views.reserve(retired.sightings.size());
  for (const PointSighting& s : retired.sightings)
    point.views.push_back({static_cast<std::uint32_t>(s.frame), s.px.cast<float>(), true});
  return point;
}

LineRecord recordOf(const RetiredLine& retired) {
  LineRecord line;
  line.id = retired.id;
  line.known = retired.triangulated && !retired.degenerate;
  line.parallel = retired.group != 0;
  if (line.known) {
    line.estimate.middle_w = retired.line_w.nearestPoint();
    line.estimate.direction_w = retired.line_w.d.normalized();
  }
  line.views.reserve(retired.sightings.size());
  for (const LineSighting& s : retired.sightings)
    line.views.push_back(
        {s.frame, retired.id, s.start_px.cast<float>(), s.end_px.cast<float>(), static_cast<float>(s.sigma_px), true});
  return line;
}

/// Only what keyframes saw, in their order.
template <class Record>
void keepKeyframesOnly(const std::set<FrameId>& keyframes, std::vector<Record>& records) {
  for (Record& record : records) {
    auto& views = record.views;
    views.erase(
        std::remove_if(views.begin(), views.end(), [&](const auto& v) { return keyframes.count(v.keyframe) == 0; }),
        views.end());
    std::stable_sort(views.begin(), views.end(), [](const auto& a, const auto& b) { return a.keyframe < b.keyframe; });
  }
  records.erase(std::remove_if(records.begin(), records.end(), [](const Record& r) { return r.views.size() < 2; }),
                records.end());
}

/// Ascending ids. A track that outlived a restart of the estimator is there once a world: the first keeps the track's
/// id, the others get ids beyond all tracks'.
template <class Record>
void orderById(std::vector<Record>& records) {
  const auto by_id = [](const Record& a, const Record& b) { return a.id < b.id; };
  std::stable_sort(records.begin(), records.end(), by_id);
  std::uint64_t next = records.empty() ? 0 : records.back().id + 1;
  std::uint64_t before = next;
  for (Record& record : records) {
    const std::uint64_t id = record.id;
    if (id == before) record.id = next++;
    before = id;
  }
  std::stable_sort(records.begin(), records.end(), by_id);
}

}  // namespace

MapBuilder::MapBuilder(const Rig& rig, const MapParams& params) : params_(params) {
  checkRanges(params, "map.");
  material_.rig = rig;
}

void MapBuilder::add(const WindowUpdate& update) {
  if (frames_ns_.empty() || update.t_ns > frames_ns_.back()) frames_ns_.push_back(update.t_ns);
  if (update.startWasWrong()) return withdrawStart();
  for (const FramePose& frame : update.replaced) material_.trajectory.emplace_back(frame.t_ns, frame.T_w_b);
  if (update.hasPose()) material_.trajectory.emplace_back(update.t_ns, update.T_w_b);
  material_.keyframes.insert(material_.keyframes.end(), update.keyframes.begin(), update.keyframes.end());
  for (const RetiredPoint& point : update.points) material_.points.push_back(recordOf(point));
  for (const RetiredLine& line : update.lines) material_.lines.push_back(recordOf(line));
  if (update.status == EstimatorStatus::kLost)
    settled_ = {material_.keyframes.size(), material_.points.size(), material_.lines.size(),
                material_.trajectory.size()};
}

void MapBuilder::withdrawStart() {
  material_.keyframes.resize(settled_.keyframes);
  material_.points.resize(settled_.points);
  material_.lines.resize(settled_.lines);
  material_.trajectory.resize(settled_.poses);
}

void MapBuilder::setCalibration(const Rig& rig, double time_offset_s) {
  material_.rig = rig;
  material_.time_offset_s = time_offset_s;
}

MapMaterial MapBuilder::material() const { return MapBuilder(*this).takeMaterial(); }

MapMaterial MapBuilder::takeMaterial() {
  MapMaterial material = std::move(material_);
  std::stable_sort(material.keyframes.begin(), material.keyframes.end(),
                   [](const RetiredKeyframe& a, const RetiredKeyframe& b) { return a.id < b.id; });
  std::set<FrameId> ids;
  for (const RetiredKeyframe& keyframe : material.keyframes) ids.insert(keyframe.id);
  keepKeyframesOnly(ids, material.points);
  keepKeyframesOnly(ids, material.lines);
  orderById(material.points);
  orderById(material.lines);
  addPosesOfStarts(frames_ns_, material);
  material.pieces = separatePieces(material);
  return material;
}

LineMap MapBuilder::build() const {
  MapMaterial prepared = material();
  prepareMaterial(params_, prepared);
  return drawMap(params_, prepared);
}

void prepareMaterial(const MapParams& params, MapMaterial& material) {
  MapFitting fitting(params, material);
  fitting.fitAll();
  fitting.merge({});
  if (params.degenerate_lines == "constrain") fitting.tie();
}

void settleLines(const MapParams& params, MapMaterial& material) {
  MapFitting fitting(params, material);
  MergeAllowance allowance;
  allowance.contrast = true;
  if (params.merge.lines) fitting.mergeLines(allowance);
  if (params.degenerate_lines != "constrain") return;
  fitting.tie();
  fitting.align();
}

}  // namespace lintel
