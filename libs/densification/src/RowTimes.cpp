// SPDX-License-Identifier: BSD-3-Clause
#include "RowTimes.h"

#include <algorithm>
#include <unordered_map>

#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

namespace {

constexpr double kShort_s = 1e-4;  // of a readout: less than that is none

std::vector<double> usualInverseDistances(const MapMaterial& material) {
  std::unordered_map<FrameId, std::size_t> place;
  std::vector<std::vector<double>> inverse(material.keyframes.size());
  for (std::size_t k = 0; k < material.keyframes.size(); ++k) place.emplace(material.keyframes[k].id, k);
  for (const PointRecord& point : material.points)
    for (const PointView& view : point.views)
      if (const auto k = place.find(view.keyframe); point.known && view.inlier && k != place.end())
        inverse[k->second].push_back(
            1 / std::max(1e-3, (point.p_w - (material.keyframes[k->second].T_w_b * material.rig.T_b_c).p).norm()));
  std::vector<double> usual;
  usual.reserve(inverse.size());
  for (std::vector<double>& values : inverse) usual.push_back(values.empty() ? 0 : upperMedian(values));
  return usual;
}

}  // namespace

RowTimes::RowTimes(const MapMaterial& material) : material_(material), readout_s_(material.rig.readout_s()) {
  if (std::abs(readout_s_) > kShort_s) inverse_distance_ = usualInverseDistances(material);
}

void RowTimes::move(std::size_t k, std::vector<EdgeSegment>& edges) const {
  if (inverse_distance_.empty()) return;
  const RetiredKeyframe& keyframe = material_.keyframes[k];
  const Rig& rig = material_.rig;
  const Eigen::Vector3d omega_b = turnRate_b(keyframe), v_b = keyframe.T_w_b.q.conjugate() * keyframe.v_w_b;
  const Eigen::Quaterniond R_c_b = rig.T_b_c.q.conjugate();
  const Eigen::Vector3d omega_c = R_c_b * omega_b, v_c = R_c_b * (v_b + omega_b.cross(rig.T_b_c.p));
  const auto moved = [&](const Eigen::Vector2d& px) -> Eigen::Vector2d {
    const double dt_s = readout_s_ * (px.y() - 0.5 * (rig.camera.height - 1)) / rig.camera.height;
    const Eigen::Vector3d ray =
        expRotation(omega_c * dt_s) * rig.camera.ray(px).normalized() + v_c * (dt_s * inverse_distance_[k]);
    return rig.camera.projects(ray) ? rig.camera.project(ray) : px;
  };
  for (EdgeSegment& edge : edges) edge.start_px = moved(edge.start_px), edge.end_px = moved(edge.end_px);
}

Eigen::Vector3d RowTimes::turnRate_b(const RetiredKeyframe& keyframe) const {
  if (keyframe.imu && !keyframe.imu->samples().empty()) return motionOf(keyframe).omega_b;
  // a map that was read has no IMU samples: from the poses before and after
  const auto& poses = material_.trajectory;
  const auto at = std::lower_bound(poses.begin(), poses.end(), keyframe.t_ns,
                                   [](const auto& pose, std::int64_t t_ns) { return pose.first < t_ns; });
  if (at == poses.end()) return Eigen::Vector3d::Zero();
  const auto before = at == poses.begin() ? at : std::prev(at),
             after = std::next(at) == poses.end() ? at : std::next(at);
  if (before == after) return Eigen::Vector3d::Zero();
  return logRotation(before->second.q.conjugate() * after->second.q) *
         (1e9 / static_cast<double>(after->first - before->first));
}

}  // namespace lintel
