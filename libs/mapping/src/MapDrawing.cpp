// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "CameraErrors.h"
#include "LineGroups.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/ImagePoses.h"
#include "lintel/mapping/LineEvidence.h"
#include "lintel/mapping/LineFitting.h"
#include "lintel/mapping/MapBuilder.h"

namespace lintel {

namespace {

/// Makes map entries of records that have enough evidence.
class MapDrawer {
 public:
  MapDrawer(const MapParams& params, const MapMaterial& material)
      : params_(params), material_(material), cameras_(material) {}

  std::optional<MapPoint> draw(const PointRecord& point) const {
    MapPoint result;
    for (const PointView& v : point.views)
      if (v.inlier) result.observations.push_back({v.keyframe, v.px.cast<double>()});
    if (!point.known || static_cast<int>(result.observations.size()) < params_.min_observations) return std::nullopt;
    const double distance = (point.p_w - cameras_.T_w_c(result.observations.front().keyframe_id).p).norm();
    if (!(point.sigma_distance_m <= params_.point_max_relative_sigma * distance)) return std::nullopt;
    result.id = point.id;
    result.p_w = point.p_w;
    result.sigma_distance_m = point.sigma_distance_m;
    result.first_t_ns = timeOf(result.observations.front().keyframe_id);
    result.last_t_ns = timeOf(result.observations.back().keyframe_id);
    return result;
  }

  std::optional<MapLine> draw(const LineRecord& line) const {
    const LineEvidence evidence = evidenceOf(params_, cameras_, line);
    if (!evidence.known) return std::nullopt;
    MapLine result;
    result.covariance = covarianceAt(line.estimate, evidence.segment_w);
    LineEstimate whole = line.estimate;
    whole.covariance += covarianceByCameras(cameras_, material_.camera_errors, line);
    const auto sigmaAt = [&](const Eigen::Vector3d& end) {
      return whole.sigmaPosition((end - whole.middle_w).dot(whole.direction_w));
    };
    result.sigma_direction_rad = whole.sigmaDirection();
    result.sigma_distance_m = std::max(sigmaAt(evidence.segment_w.start), sigmaAt(evidence.segment_w.end));
    result.id = line.id;
    result.segment_w = evidence.segment_w;
    result.mapped = line.mapped;
    result.constrained = line.tie.has_value();
    result.degenerate = result.constrained || evidence.degenerate;
    for (const LineView& v : line.views)
      if (v.inlier) result.observations.push_back(observationOf(v, result.segment_w));
    result.first_t_ns = timeOf(result.observations.front().keyframe_id);
    result.last_t_ns = timeOf(result.observations.back().keyframe_id);
    return result;
  }

 private:
  static LineCovariance covarianceAt(const LineEstimate& line, const Segment3& segment_w) {
    const Eigen::Vector3d d = segment_w.direction();
    const Eigen::Matrix2d turn = tangentBasis(d).transpose() * tangentBasis(line.direction_w);
    const double along_m = (segment_w.midpoint() - line.middle_w).dot(line.direction_w);
    Eigen::Matrix4d move;
    move << turn, along_m * turn, Eigen::Matrix2d::Zero(), (d.dot(line.direction_w) < 0 ? -1 : 1) * turn;
    return (move * line.covariance * move.transpose()).cast<float>();
  }

  /// Tracks of a merged line may run the other way: start and end of the views follow the segment's.
  MapLineObservation observationOf(const LineView& view, const Segment3& segment_w) const {
    const Eigen::Matrix3d& R_c_w = cameras_.R_c_w(view.keyframe);
    const Eigen::Vector3d& p_w_c = cameras_.T_w_c(view.keyframe).p;
    const Eigen::Vector3d start_c = R_c_w * (segment_w.start - p_w_c), end_c = R_c_w * (segment_w.end - p_w_c);
    // a view and its line run the same way when their planes' normals agree
    const Eigen::Vector2d start_px = view.start_px.cast<double>(), end_px = view.end_px.cast<double>();
    const Eigen::Vector3d seen = cameras_.ray(start_px).cross(cameras_.ray(end_px));
    const bool turned = seen.dot(start_c.cross(end_c)) < 0;
    return {view.keyframe, turned ? end_px : start_px, turned ? start_px : end_px};
  }

  std::int64_t timeOf(FrameId id) const { return material_.keyframes[cameras_.placeOf(id)].t_ns; }

  const MapParams& params_;
  const MapMaterial& material_;
  KeyframeCameras cameras_;
};

}  // namespace

LineMap drawMap(const MapParams& params, const MapMaterial& material) {
  LineMap map;
  map.rig = material.rig;
  map.trajectory = posesOfImages(material);
  map.time_offset_s = material.time_offset_s;
  map.pieces = material.pieces;
  map.camera_errors = material.camera_errors;
  for (const RetiredKeyframe& k : material.keyframes)
    map.keyframes.push_back(
        {k.id, k.t_ns, k.T_w_b, k.v_w_b, k.bias.gyro, k.bias.accel, k.imu, k.at_rest, k.offset_change_s});
  const MapDrawer drawer(params, material);
  for (const PointRecord& record : material.points)
    if (auto point = drawer.draw(record)) map.points.push_back(std::move(*point));
  for (const LineRecord& record : material.lines)
    if (auto line = drawer.draw(record)) map.lines.push_back(std::move(*line));
  map.groups = findGroups(params.groups, map.lines);
  return map;
}

}  // namespace lintel
