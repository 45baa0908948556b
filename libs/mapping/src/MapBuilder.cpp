// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapBuilder.h"

#include <algorithm>
#include <set>

#include "lintel/geometry/PluckerLine.h"
#include "lintel/mapping/SegmentEnds.h"

namespace lintel {

void MapBuilder::add(const WindowUpdate& update) {
  if (update.hasPose()) trajectory_.emplace_back(update.t_ns, update.T_w_b);
  for (const RetiredKeyframe& keyframe : update.keyframes) keyframes_[keyframe.id] = keyframe;
  for (const RetiredPoint& point : update.points)
    if (point.triangulated) points_.push_back(point);
  for (const RetiredLine& line : update.lines)
    if (line.triangulated) lines_.push_back(line);
}

namespace {

using Keyframes = std::map<FrameId, RetiredKeyframe>;

/// The segment of a line that its sightings support, and the distance it was seen from.
struct SeenSegment {
  Segment3 segment_w;
  double distance_m = 0;
};

/// Whether a ray meets the line steeply enough to say where along it: at grazing angles a small error of the direction
/// moves the meeting point far.
bool meetsSteeply(const Eigen::Vector3d& end_c, const Eigen::Vector3d& d_c, double sigma_direction_rad) {
  constexpr double kLeastSine = 0.05, kSigmas = 3;
  return end_c.normalized().cross(d_c).norm() > std::max(kLeastSine, kSigmas * sigma_direction_rad);
}

std::optional<SeenSegment> seenSegment(const RetiredLine& line, const Keyframes& keyframes, const Rig& rig,
                                       double coverage) {
  const Eigen::Vector3d d_w = line.line_w.d.normalized(), foot_w = line.line_w.nearestPoint();
  std::vector<std::pair<double, double>> intervals;
  std::vector<double> distances;
  for (const LineSighting& s : line.sightings) {
    const auto keyframe = keyframes.find(s.frame);
    if (keyframe == keyframes.end()) continue;
    const Pose T_w_c = keyframe->second.T_w_b * rig.T_b_c, T_c_w = T_w_c.inverse();
    const Eigen::Vector3d p_c = T_c_w * foot_w, d_c = T_c_w.q * d_w;
    const PluckerLine line_c{p_c.cross(d_c), d_c};
    Eigen::Vector3d ends_c[2];
    if (!closestPointToRay(line_c, rig.camera.normalise(s.start_px), ends_c[0]) ||
        !closestPointToRay(line_c, rig.camera.normalise(s.end_px), ends_c[1]) || ends_c[0].z() < 0.05 ||
        ends_c[1].z() < 0.05 || !meetsSteeply(ends_c[0], d_c, line.sigma_direction_rad) ||
        !meetsSteeply(ends_c[1], d_c, line.sigma_direction_rad))
      continue;
    const auto along = [&](const Eigen::Vector3d& e_c) { return (T_w_c * e_c - foot_w).dot(d_w); };
    intervals.emplace_back(along(ends_c[0]), along(ends_c[1]));
    distances.push_back(0.5 * (ends_c[0].norm() + ends_c[1].norm()));
  }
  const auto stretch = coveredStretch(intervals, coverage);
  if (!stretch) return std::nullopt;
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2), distances.end());
  const bool forward = intervals.front().second >= intervals.front().first;
  const double from = forward ? stretch->first : stretch->second, to = forward ? stretch->second : stretch->first;
  return SeenSegment{{foot_w + from * d_w, foot_w + to * d_w}, distances[distances.size() / 2]};
}

std::int64_t timeOf(const Keyframes& keyframes, FrameId id) { return keyframes.at(id).t_ns; }

template <class Sighting>
std::vector<Sighting> inKeyframes(const std::vector<Sighting>& sightings, const Keyframes& keyframes) {
  std::vector<Sighting> result;
  std::copy_if(sightings.begin(), sightings.end(), std::back_inserter(result),
               [&](const Sighting& s) { return keyframes.count(s.frame) > 0; });
  return result;
}

/// Ascending ids. A track that outlived a restart of the estimator is there once a world: the first keeps the track's
/// id, the others get ids beyond all tracks'.
template <class Landmark>
void orderById(std::vector<Landmark>& landmarks) {
  const auto by_id = [](const Landmark& a, const Landmark& b) { return a.id < b.id; };
  std::stable_sort(landmarks.begin(), landmarks.end(), by_id);
  std::set<std::uint64_t> taken;
  std::uint64_t next = landmarks.empty() ? 0 : landmarks.back().id + 1;
  for (Landmark& landmark : landmarks)
    if (!taken.insert(landmark.id).second) landmark.id = next++;
  std::stable_sort(landmarks.begin(), landmarks.end(), by_id);
}

}  // namespace

LineMap MapBuilder::build() const {
  LineMap map;
  map.rig = rig_;
  map.trajectory = trajectory_;
  for (const auto& [id, k] : keyframes_) map.keyframes.push_back({id, k.t_ns, k.T_w_b, k.v_w_b, k.bias.gyro, k.bias.accel});

  for (const RetiredPoint& point : points_) {
    const auto sightings = inKeyframes(point.sightings, keyframes_);
    if (static_cast<int>(sightings.size()) < params_.min_observations) continue;
    const double distance = (point.p_w - keyframes_.at(sightings.front().frame).T_w_b.p).norm();
    if (!(point.sigma_distance_m <= params_.point_max_relative_sigma * distance)) continue;
    MapPoint p;
    p.id = point.id;
    p.p_w = point.p_w;
    p.sigma_distance_m = point.sigma_distance_m;
    p.first_t_ns = timeOf(keyframes_, sightings.front().frame);
    p.last_t_ns = timeOf(keyframes_, sightings.back().frame);
    for (const PointSighting& s : sightings) p.observations.push_back({s.frame, s.px});
    map.points.push_back(std::move(p));
  }

  for (const RetiredLine& line : lines_) {
    const auto sightings = inKeyframes(line.sightings, keyframes_);
    if (line.degenerate || static_cast<int>(sightings.size()) < params_.min_observations) continue;
    const auto seen = seenSegment(line, keyframes_, rig_, params_.coverage);
    if (!seen || seen->segment_w.length() < params_.min_length_m) continue;
    if (!(line.sigma_direction_rad <= params_.max_sigma_direction_rad) ||
        !(line.sigma_distance_m <= params_.max_relative_sigma * seen->distance_m))
      continue;
    MapLine l;
    l.id = line.id;
    l.segment_w = seen->segment_w;
    l.sigma_direction_rad = line.sigma_direction_rad;
    l.sigma_distance_m = line.sigma_distance_m;
    l.degenerate = line.degenerate;
    l.first_t_ns = timeOf(keyframes_, sightings.front().frame);
    l.last_t_ns = timeOf(keyframes_, sightings.back().frame);
    for (const LineSighting& s : sightings) l.observations.push_back({s.frame, s.start_px, s.end_px});
    map.lines.push_back(std::move(l));
  }
  orderById(map.points);
  orderById(map.lines);
  return map;
}

}  // namespace lintel
