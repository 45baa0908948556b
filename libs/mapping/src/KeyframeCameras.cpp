// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/KeyframeCameras.h"

#include "lintel/factors/CameraView.h"

namespace lintel {

std::optional<ImuAt> imuAtKeyframe(const std::vector<RetiredKeyframe>& keyframes, std::size_t k, double reach_s) {
  const Preintegration* next = k + 1 < keyframes.size() ? keyframes[k + 1].imu.get() : nullptr;
  const bool goes_on = next && !next->samples().empty() && next->samples().front().t_ns == keyframes[k].t_ns;
  return imuAt(keyframes[k].imu.get(), goes_on ? next : nullptr, reach_s);
}

FrameMotion motionOf(const std::vector<RetiredKeyframe>& keyframes, std::size_t k) {
  const RetiredKeyframe& keyframe = keyframes[k];
  FrameMotion motion;
  motion.v_b = keyframe.T_w_b.q.conjugate() * keyframe.v_w_b;
  if (const auto imu = imuAtKeyframe(keyframes, k))
    motion.omega_b = imu->gyro - keyframe.bias.gyro;
  else if (keyframe.imu && !keyframe.imu->samples().empty())
    motion.omega_b = keyframe.imu->samples().back().gyro - keyframe.bias.gyro;
  return motion;
}

std::vector<RetiredKeyframe> retiredKeyframes(const LineMap& map) {
  std::vector<RetiredKeyframe> keyframes;
  for (const MapKeyframe& keyframe : map.keyframes) {
    RetiredKeyframe k;
    k.id = keyframe.id, k.t_ns = keyframe.t_ns, k.T_w_b = keyframe.T_w_b, k.v_w_b = keyframe.v_w_b;
    k.bias = {keyframe.bias_gyro, keyframe.bias_accel};
    k.imu = keyframe.imu, k.at_rest = keyframe.at_rest, k.offset_change_s = keyframe.offset_change_s;
    keyframes.push_back(k);
  }
  return keyframes;
}

KeyframeCameras::KeyframeCameras(const MapMaterial& material)
    : KeyframeCameras(material.rig, material.time_offset_s, material.keyframes) {}

KeyframeCameras::KeyframeCameras(const LineMap& map)
    : KeyframeCameras(map.rig, map.time_offset_s, retiredKeyframes(map)) {}

KeyframeCameras::KeyframeCameras(const Rig& rig, double time_offset_s, const std::vector<RetiredKeyframe>& keyframes)
    : camera_(rig.camera) {
  const PoseBlock extrinsics = toBlock(rig.T_b_c);
  CorrectionBlock correction = CorrectionBlock::Zero();
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const RetiredKeyframe& keyframe = keyframes[k];
    if (keyframe.id >= places_.size()) places_.resize(keyframe.id + 1, -1);
    places_[keyframe.id] = static_cast<std::int64_t>(T_w_c_.size());
    correction[kTimeOffsetAt] = time_offset_s + keyframe.offset_change_s;
    const PoseBlock pose = toBlock(keyframe.T_w_b);
    const CameraView view(pose.data(), extrinsics.data(), correction.data(), motionOf(keyframes, k), false);
    T_w_c_.push_back({Eigen::Quaterniond(view.R_c_w.transpose()).normalized(), view.p_w_c});
    R_c_w_.push_back(view.R_c_w);
  }
}

}  // namespace lintel
