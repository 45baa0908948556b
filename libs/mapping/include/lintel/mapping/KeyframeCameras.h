// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "lintel/factors/FrameMotion.h"
#include "lintel/inertial/ImuAt.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// Where the camera was when each keyframe's image was taken.
class KeyframeCameras {
 public:
  explicit KeyframeCameras(const MapMaterial& material);
  explicit KeyframeCameras(const LineMap& map);

  bool contains(FrameId id) const { return id < places_.size() && places_[id] >= 0; }
  std::size_t placeOf(FrameId id) const { return static_cast<std::size_t>(places_[id]); }  ///< in material.keyframes
  const Pose& T_w_c(FrameId id) const { return T_w_c_[placeOf(id)]; }
  const Eigen::Matrix3d& R_c_w(FrameId id) const { return R_c_w_[placeOf(id)]; }
  const Camera& camera() const { return camera_; }

  /// Of a raw pixel (Camera.h).
  Eigen::Vector3d ray(const Eigen::Vector2d& px) const { return camera_.ray(px); }

 private:
  KeyframeCameras(const Rig& rig, double time_offset_s, const std::vector<RetiredKeyframe>& keyframes);

  Camera camera_;
  std::vector<std::int64_t> places_;  // by keyframe id, -1 = none
  std::vector<Pose> T_w_c_;
  std::vector<Eigen::Matrix3d> R_c_w_;
};

/// The keyframes of a map as those that it was made of.
std::vector<RetiredKeyframe> retiredKeyframes(const LineMap& map);

/// What the IMU measured at keyframe `k`; nothing where its samples are not known.
std::optional<ImuAt> imuAtKeyframe(const std::vector<RetiredKeyframe>& keyframes, std::size_t k,
                                   double reach_s = kImuReach_s);

/// How the body moves at keyframe `k`.
FrameMotion motionOf(const std::vector<RetiredKeyframe>& keyframes, std::size_t k);

}  // namespace lintel
