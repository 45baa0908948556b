// SPDX-License-Identifier: BSD-3-Clause
#include "Drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "GroupNames.h"
#include "lintel/core/Quantiles.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

namespace {

bool drawable(const Eigen::Vector3d& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() < 1e30;  // squares stay within a float's range in viewers
}

bool drawable(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return drawable(a) && drawable(b) && a.cast<float>() != b.cast<float>();
}

bool wanted(const MapLine& line, const ExportParams& params) {
  return static_cast<int>(line.observations.size()) >= params.min_observations &&
         !(line.segment_w.length() < params.min_length_m) && !(line.sigma_distance_m > params.max_sigma_m);
}

bool wanted(const MapPoint& point, const ExportParams& params) {
  return static_cast<int>(point.observations.size()) >= params.min_observations &&
         !(point.sigma_distance_m > params.max_sigma_m);
}

void selectLines(const LineMap& map, const ExportParams& params, Drawing& drawing) {
  for (const MapLine& line : map.lines) {
    if (!drawable(line.segment_w.start, line.segment_w.end)) {
      ++drawing.summary.dropped;
    } else if (!wanted(line, params)) {
      ++drawing.summary.filtered;
    } else {
      drawing.lines.push_back(&line);
    }
  }
  drawing.summary.lines = drawing.lines.size();
}

void addLines(const ExportParams& params, Drawing& drawing) {
  const LineColouring colouring(params.colour, drawing.lines);
  const GroupNames names(*drawing.map);
  drawing.legend = colouring.legend(drawing.lines, names);
  std::map<int, DrawnPart> groups;
  for (const MapLine* line : drawing.lines) {
    const int group = std::max(line->group, -1);
    groups[group].segments.push_back({line->segment_w.start, line->segment_w.end, colouring(*line), line});
  }
  for (auto& [group, part] : groups) {
    part.name = "Lines " + names(group);
    part.group = group;
    drawing.parts.push_back(std::move(part));
  }
}

/// Where points are drawn: around the lines. Viewers fit all that is there into their window, and a few points at the
/// horizon would shrink the lines to a dot.
Eigen::AlignedBox3d roomForPoints(const Drawing& drawing) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.5 * drawing.core.diagonal().norm());
  return {drawing.core.min() - margin, drawing.core.max() + margin};
}

void addPoints(const ExportParams& params, bool far_points, Drawing& drawing) {
  DrawnPart part{"Points", MapLayer::kPoints, -1, {}, {}};
  const bool all = far_points || drawing.lines.empty();
  const Eigen::AlignedBox3d room = roomForPoints(drawing);
  for (const MapPoint& point : drawing.map->points) {
    if (!drawable(point.p_w)) {
      ++drawing.summary.dropped;
    } else if (wanted(point, params) && !all && !room.contains(point.p_w)) {
      ++drawing.summary.far_points;
    } else if (wanted(point, params)) {
      part.points.push_back({point.p_w, kPointColour, &point});
    }
  }
  drawing.summary.points = part.points.size();
  if (!part.points.empty()) drawing.parts.push_back(std::move(part));
}

void addKeyframes(Drawing& drawing) {
  DrawnPart part{"Keyframes", MapLayer::kKeyframes, -1, {}, {}};
  const Rig& rig = drawing.map->rig;
  const KeyframeCameras cameras(*drawing.map);
  for (MapKeyframe keyframe : drawing.map->keyframes) {
    const bool sound = drawable(keyframe.T_w_b);
    keyframe.T_w_b = cameras.T_w_c(keyframe.id) * rig.T_b_c.inverse();
    keyframe.imu.reset();
    const auto strokes = frustumSegments(rig, keyframe.T_w_b, drawing.frustum_m, kKeyframeColour);
    if (strokes.empty() || !sound) {
      ++drawing.summary.dropped;
      continue;
    }
    drawing.keyframes.push_back(keyframe);
    part.segments.insert(part.segments.end(), strokes.begin(), strokes.end());
  }
  drawing.summary.keyframes = drawing.keyframes.size();
  if (!part.segments.empty()) drawing.parts.push_back(std::move(part));
}

void addTrajectory(Drawing& drawing) {
  DrawnPart part{"Trajectory", MapLayer::kTrajectory, -1, {}, {}};
  const Eigen::Vector3d* previous = nullptr;
  std::set<std::uint64_t> begins;  // of pieces: nothing is known of the way to there
  for (const MapPiece& piece : drawing.map->pieces) begins.insert(piece.first_pose);
  std::uint64_t at = 0;
  for (const auto& [t_ns, T_w_b] : drawing.map->trajectory) {
    if (begins.count(at++) > 0) previous = nullptr;
    if (!drawable(T_w_b)) {
      ++drawing.summary.dropped;
      continue;
    }
    ++drawing.summary.trajectory;
    if (previous && !drawable(*previous, T_w_b.p)) continue;  // stands still
    if (previous) part.segments.push_back({*previous, T_w_b.p, kTrajectoryColour, nullptr});
    previous = &T_w_b.p;
  }
  if (!part.segments.empty()) drawing.parts.push_back(std::move(part));
}

/// The box of the middle 96 % of what is there, axis by axis: of lines if there are any, else of points and poses.
Eigen::AlignedBox3d coreOf(const Drawing& drawing) {
  std::array<std::vector<double>, 3> values;
  const auto add = [&values](const Eigen::Vector3d& p) {
    if (!drawable(p)) return;
    for (std::size_t axis = 0; axis < 3; ++axis) values[axis].push_back(p[static_cast<Eigen::Index>(axis)]);
  };
  for (const MapLine* line : drawing.lines) add(line->segment_w.start), add(line->segment_w.end);
  if (values[0].empty()) {
    for (const MapPoint& point : drawing.map->points) add(point.p_w);
    for (const auto& [t_ns, T_w_b] : drawing.map->trajectory) add(T_w_b.p);
  }
  Eigen::AlignedBox3d box;
  if (values[0].empty()) return {Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    auto& along = values[static_cast<std::size_t>(axis)];
    box.min()[axis] = nearestQuantile(along, 0.02);
    box.max()[axis] = nearestQuantile(along, 0.98);
  }
  return box;
}

/// Of tubes: to be seen beside the core of the map, and not lost in a view of everything that is drawn.
double defaultRadius(const Drawing& drawing) {
  const double core_m = std::max(drawing.core.diagonal().norm(), 1e-3);
  Eigen::AlignedBox3d whole = drawing.core;
  for (const MapLine* line : drawing.lines) whole.extend(line->segment_w.start).extend(line->segment_w.end);
  const double radius_m = std::clamp(0.001 * whole.diagonal().norm(), 0.0015 * core_m, 0.0025 * core_m);
  return std::clamp(radius_m, 1e-5, 0.05);
}

/// Of keyframes: to be seen beside the map, but where keyframes stand close together no larger than their distance, so
/// that they do not hide everything.
double frustumDepth(const Drawing& drawing) {
  const double extent_m = std::max(drawing.core.diagonal().norm(), 1e-3);
  std::vector<double> gaps_m;
  const auto& keyframes = drawing.map->keyframes;
  for (std::size_t i = 1; i < keyframes.size(); ++i) {
    const double gap_m = (keyframes[i].T_w_b.p - keyframes[i - 1].T_w_b.p).norm();
    if (std::isfinite(gap_m)) gaps_m.push_back(gap_m);
  }
  const double widest_m = std::clamp(0.02 * extent_m, 1e-4, 0.3);
  return gaps_m.empty() ? widest_m : std::clamp(nearestQuantile(gaps_m, 0.5), 0.3 * widest_m, widest_m);
}

/// Where the image's border is on the plane z = 1, from its `distance` to the centre over the focal length: of wide
/// lenses about the angle, drawn up to 60 degrees.
double onPlane(const Camera& camera, double distance) {
  constexpr double kWidest_rad = 1.0472;
  return camera.wide() ? std::tan(std::clamp(distance, -kWidest_rad, kWidest_rad)) : distance;
}

}  // namespace

bool drawable(const Pose& T) { return drawable(T.p) && std::abs(T.q.norm() - 1) < 1e-3; }

std::vector<DrawnSegment> frustumSegments(const Rig& rig, const Pose& T_w_b, double depth_m, Rgb colour) {
  const Camera& camera = rig.camera;
  // A map without a calibration still shows where its keyframes are: a camera of 90 degrees.
  const bool calibrated = camera.fx > 0 && camera.fy > 0 && camera.width > 0 && camera.height > 0;
  const double right = calibrated ? onPlane(camera, (camera.width - camera.cx) / camera.fx) : 1,
               left = calibrated ? onPlane(camera, -camera.cx / camera.fx) : -1;
  const double bottom = calibrated ? onPlane(camera, (camera.height - camera.cy) / camera.fy) : 1,
               top = calibrated ? onPlane(camera, -camera.cy / camera.fy) : -1;
  const Pose T_w_c = T_w_b * rig.T_b_c;
  const Eigen::Vector3d eye = T_w_c.p;
  std::array<Eigen::Vector3d, 4> corners{{{left, top, 1}, {right, top, 1}, {right, bottom, 1}, {left, bottom, 1}}};
  for (Eigen::Vector3d& corner : corners) corner = T_w_c * (depth_m * corner);
  std::vector<DrawnSegment> strokes;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!drawable(eye, corners[i]) || !drawable(corners[i], corners[(i + 1) % 4])) return {};
    strokes.push_back({eye, corners[i], colour, nullptr});
    strokes.push_back({corners[i], corners[(i + 1) % 4], colour, nullptr});
  }
  return strokes;
}

Drawing makeDrawing(const LineMap& map, const ExportParams& params, bool far_points) {
  Drawing drawing;
  drawing.map = &map;
  drawing.style = *params.style;
  drawing.colour = params.colour;
  const auto& layers = *params.layers;
  if (layers.count(MapLayer::kLines)) selectLines(map, params, drawing);
  drawing.core = coreOf(drawing);
  drawing.radius_m = params.radius_m > 0 ? params.radius_m : defaultRadius(drawing);
  drawing.frustum_m = frustumDepth(drawing);
  addLines(params, drawing);
  if (layers.count(MapLayer::kPoints)) addPoints(params, far_points, drawing);
  if (layers.count(MapLayer::kKeyframes)) addKeyframes(drawing);
  if (layers.count(MapLayer::kTrajectory)) addTrajectory(drawing);
  std::vector<const MapPoint*> points;
  for (const DrawnPart& part : drawing.parts)
    for (const DrawnPoint& point : part.points) points.push_back(point.point);
  drawing.structure = drawnStructure(map, drawing.lines, points);
  return drawing;
}

}  // namespace lintel
