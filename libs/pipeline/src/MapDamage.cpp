// SPDX-License-Identifier: BSD-3-Clause
#include "MapDamage.h"

#include <algorithm>

#include "lintel/inertial/Preintegration.h"

namespace lintel {

namespace {

constexpr double kFarthest = 1e7;  // [m], [m/s]
constexpr std::int64_t kDay_ns = 86'400'000'000'000;
constexpr std::int64_t kLongest_ns = 30 * kDay_ns;  // of a piece

bool sound(const Eigen::Vector3d& v) { return v.allFinite() && v.norm() < kFarthest; }
bool sound(const Pose& T) { return sound(T.p) && std::abs(T.q.norm() - 1) < 1e-3; }

bool sound(const MapKeyframe& k) {
  if (!sound(k.T_w_b) || !sound(k.v_w_b) || !sound(k.bias_gyro) || !sound(k.bias_accel)) return false;
  return !k.imu || (sound(k.imu->deltaP()) && sound(k.imu->deltaV()) && k.imu->covariance().allFinite());
}

bool sound(const Rig& rig) {
  const Camera& camera = rig.camera;
  return camera.width > 0 && camera.height > 0 && camera.fx > 0 && camera.fy > 0 && sound(rig.T_b_c);
}

/// Times of keyframes, poses and views: those of their piece, within a day.
bool soundTimes(const LineMap& map) {
  const auto ofPiece = [&](std::size_t piece, std::int64_t t_ns) {
    return t_ns > map.pieces[piece].first_ns - kDay_ns && t_ns < map.pieces[piece].last_ns + kDay_ns;
  };
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    if (map.pieces[p].last_ns - map.pieces[p].first_ns > kLongest_ns) return false;
    const auto [from, to] = posesOf(map.pieces, p, map.trajectory.size());
    for (std::size_t i = from; i < to; ++i)
      if (!ofPiece(p, map.trajectory[i].first)) return false;
  }
  return std::all_of(map.keyframes.begin(), map.keyframes.end(),
                     [&](const MapKeyframe& k) { return ofPiece(pieceOf(map.pieces, k.id), k.t_ns); }) &&
         std::all_of(map.views.begin(), map.views.end(), [&](const MapView& view) {
           return ofPiece(static_cast<std::size_t>(view.piece), view.looks.t_ns);
         });
}

}  // namespace

bool isDamaged(const LineMap& map) {
  return !sound(map.rig) ||
         !std::all_of(map.keyframes.begin(), map.keyframes.end(), [](const auto& k) { return sound(k); }) ||
         !std::all_of(map.trajectory.begin(), map.trajectory.end(), [](const auto& p) { return sound(p.second); }) ||
         (!map.pieces.empty() && !soundTimes(map));
}

}  // namespace lintel
