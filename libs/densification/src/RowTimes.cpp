// SPDX-License-Identifier: BSD-3-Clause
#include "RowTimes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "lintel/core/Quantiles.h"
#include "lintel/geometry/Frames.h"
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
  const Camera& camera = material_.rig.camera;
  const RowMotion motion = motionDuring(k);
  const auto rayAtFrameTime = [&](const Eigen::Vector2d& px) {
    return motion.rayAtFrameTime(camera.ray(px).normalized(), rowShare(camera, px) * readout_s_, inverse_distance_[k]);
  };
  for (EdgeSegment& edge : edges) {
    const auto [start_px, end_px] =
        lineAtFrameTime(camera, camera, edge.start_px.cast<double>(), edge.end_px.cast<double>(), rayAtFrameTime);
    edge.start_px = start_px.cast<float>(), edge.end_px = end_px.cast<float>();
  }
}

RowMotion RowTimes::motionDuring(std::size_t k) const {
  const RetiredKeyframe& keyframe = material_.keyframes[k];
  const auto imu = imuAtKeyframe(material_.keyframes, k, std::max(kImuReach_s, 0.5 * std::abs(readout_s_)));
  FrameMotion motion = motionOf(material_.keyframes, k);
  if (!imu) motion.omega_b = turnRateByPoses_b(keyframe);
  return {material_.rig.T_b_c, motion,
          imu ? motionChange(*imu, keyframe.bias.accel, keyframe.T_w_b.q, gravityW(material_.rig.gravity_m_s2))
              : MotionChange{}};
}

/// A map that was read may have no IMU samples.
Eigen::Vector3d RowTimes::turnRateByPoses_b(const RetiredKeyframe& keyframe) const {
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
