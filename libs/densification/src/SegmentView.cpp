// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentView.h"

namespace lintel {

SegmentView::SegmentView(const KeyframeCameras& cameras, FrameId id, std::vector<EdgeSegment> edges)
    : keyframe(id),
      camera(&cameras.camera()),
      R_c_w(cameras.R_c_w(id)),
      p_w_c(cameras.T_w_c(id).p),
      segments(std::move(edges)),
      taken(segments.size(), 0) {
  const auto n = static_cast<Eigen::Index>(segments.size());
  start.resize(n, 3), end.resize(n, 3), normal.resize(n, 3), length.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const EdgeSegment& s = segments[static_cast<std::size_t>(i)];
    const Eigen::Vector3d a = cameras.ray(s.start_px.cast<double>()).normalized(),
                          b = cameras.ray(s.end_px.cast<double>()).normalized();
    const Eigen::Vector3d cross = a.cross(b);
    start.row(i) = a.cast<float>(), end.row(i) = b.cast<float>();
    normal.row(i) = cross.normalized().cast<float>();
    length(i) = static_cast<float>(std::atan2(cross.norm(), a.dot(b)));
    normal_w.push_back(R_c_w.transpose() * cross.normalized());
    start_w.push_back(R_c_w.transpose() * a), end_w.push_back(R_c_w.transpose() * b);
  }
}

Eigen::Vector3d SegmentView::ray_w(const Eigen::Vector2d& px) const {
  return (R_c_w.transpose() * camera->ray(px)).normalized();
}

}  // namespace lintel
