// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/ImagePoses.h"

#include <algorithm>
#include <optional>
#include <set>

#include "lintel/factors/FrameMotion.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

using Trajectory = std::vector<std::pair<std::int64_t, Pose>>;

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return 1e-9 * static_cast<double>(to_ns - from_ns); }

/// What the offset is at a time: between two keyframes it changes evenly.
double offsetAt(const MapMaterial& material, std::int64_t t_ns) {
  const std::vector<RetiredKeyframe>& keyframes = material.keyframes;
  if (keyframes.empty()) return material.time_offset_s;
  const auto after = std::upper_bound(keyframes.begin(), keyframes.end(), t_ns,
                                      [](std::int64_t t, const RetiredKeyframe& k) { return t < k.t_ns; });
  if (after == keyframes.begin()) return material.time_offset_s + after->offset_change_s;
  const auto before = std::prev(after);
  if (after == keyframes.end()) return material.time_offset_s + before->offset_change_s;
  const double s = secondsBetween(before->t_ns, t_ns) / secondsBetween(before->t_ns, after->t_ns);
  return material.time_offset_s + (1 - s) * before->offset_change_s + s * after->offset_change_s;
}

/// The mean motion from one pose to the next.
struct Step {
  double dt_s = 0;
  Eigen::Vector3d v_w, omega_b;
};

/// Nothing where the way from the one to the other is not known: frames are missing, or another piece begins.
std::optional<Step> stepBetween(const Trajectory& poses, std::size_t from, const std::set<std::uint64_t>& begins) {
  constexpr double kLongest_s = 0.3;
  if (from + 1 >= poses.size() || begins.count(from + 1) > 0) return std::nullopt;
  const auto& [t0_ns, T0] = poses[from];
  const auto& [t1_ns, T1] = poses[from + 1];
  const double dt_s = secondsBetween(t0_ns, t1_ns);
  if (!(dt_s > 0) || dt_s > kLongest_s) return std::nullopt;
  return Step{dt_s, (T1.p - T0.p) / dt_s, logRotation(T0.q.conjugate() * T1.q) / dt_s};
}

/// At a pose, by the steps before and after it: where both are known, that of a parabola through all three.
FrameMotion motionBetween(const Pose& T_w_b, const std::optional<Step>& before, const std::optional<Step>& after) {
  if (!before && !after) return {};
  const Step& a = before ? *before : *after;
  const Step& b = after ? *after : *before;
  const double share = b.dt_s / (a.dt_s + b.dt_s);  // of the step before
  return {T_w_b.q.conjugate() * (share * a.v_w + (1 - share) * b.v_w), share * a.omega_b + (1 - share) * b.omega_b};
}

/// The poses later by `sign` times the offset.
Trajectory moved(const MapMaterial& material, const Trajectory& poses, double sign) {
  std::set<std::uint64_t> begins;
  for (const MapPiece& piece : material.pieces) begins.insert(piece.first_pose);
  Trajectory result;
  result.reserve(poses.size());
  std::optional<Step> before;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto& [t_ns, T_w_b] = poses[i];
    const std::optional<Step> after = stepBetween(poses, i, begins);
    result.emplace_back(t_ns, poseAfter(T_w_b, motionBetween(T_w_b, before, after), sign * offsetAt(material, t_ns)));
    before = after;
  }
  return result;
}

}  // namespace

std::vector<std::pair<std::int64_t, Pose>> posesOfImages(const MapMaterial& material) {
  return moved(material, material.trajectory, 1);
}

std::vector<std::pair<std::int64_t, Pose>> posesOfStates(const MapMaterial& material, const Trajectory& images) {
  return moved(material, images, -1);
}

}  // namespace lintel
