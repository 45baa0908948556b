// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/geometry/Rotation.h"
#include "lintel/geometry/Segment.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel::test {

/// Keyframes 0 to n-1 along x, `step_m` and 0.1 s apart, looking along the world's z through a camera that is mounted
/// turned. No IMU.
inline MapMaterial materialAlongX(std::size_t n = 5, double step_m = 0.5) {
  MapMaterial material;
  material.rig.camera = {752, 480, 458, 457, 367, 248, -0.28, 0.07, 2e-4, 2e-5};
  material.rig.T_b_c = {expRotation({0.1, 0.05, 1.5}), {-0.02, -0.06, 0.01}};
  for (FrameId id = 0; id < n; ++id) {
    RetiredKeyframe k;
    k.id = id;
    k.t_ns = 1000 + static_cast<std::int64_t>(id) * 100'000'000;
    k.T_w_b =
        Pose{Eigen::Quaterniond::Identity(), {step_m * static_cast<double>(id), 0, 0}} * material.rig.T_b_c.inverse();
    material.keyframes.push_back(k);
  }
  return material;
}

inline Eigen::Vector2d pixelOf(const MapMaterial& material, FrameId id, const Eigen::Vector3d& p_w) {
  return material.rig.camera.project((material.keyframes[id].T_w_b * material.rig.T_b_c).inverse() * p_w);
}

inline LineView viewOf(const MapMaterial& material, FrameId id, TrackId track, const Segment3& segment_w) {
  LineView view;
  view.keyframe = id;
  view.track = track;
  view.start_px = pixelOf(material, id, segment_w.start).cast<float>();
  view.end_px = pixelOf(material, id, segment_w.end).cast<float>();
  return view;
}

/// A line without an estimate, seen whole by keyframes `first` to `last`.
inline LineRecord lineOf(const MapMaterial& material, TrackId id, const Segment3& segment_w, FrameId first = 0,
                         FrameId last = 3) {
  LineRecord line;
  line.id = id;
  for (FrameId k = first; k <= last; ++k) line.views.push_back(viewOf(material, k, id, segment_w));
  return line;
}

inline PointRecord pointOf(const MapMaterial& material, TrackId id, const Eigen::Vector3d& p_w, FrameId first = 0,
                           FrameId last = 3) {
  PointRecord point;
  point.id = id;
  for (FrameId k = first; k <= last; ++k)
    point.views.push_back({static_cast<std::uint32_t>(k), pixelOf(material, k, p_w).cast<float>(), true});
  return point;
}

}  // namespace lintel::test
