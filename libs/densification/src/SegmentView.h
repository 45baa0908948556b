// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lintel/mapping/KeyframeCameras.h"
#include "lintel/tracking/SegmentDetector.h"

namespace lintel {

/// The edges of a keyframe's image as rays: a straight edge is a plane through the camera's centre, whatever the lens
/// makes of it.
struct SegmentView {
  using Columns = Eigen::Array<float, Eigen::Dynamic, 3>;

  SegmentView(const KeyframeCameras& cameras, FrameId id, std::vector<EdgeSegment> edges);

  std::size_t size() const { return segments.size(); }
  Eigen::Vector3d ray_w(const Eigen::Vector2d& px) const;  ///< unit

  FrameId keyframe;
  const Camera* camera;
  Eigen::Matrix3d R_c_w;
  Eigen::Vector3d p_w_c;
  std::vector<EdgeSegment> segments;
  Columns start, end;     ///< unit rays, camera frame
  Columns normal;         ///< start x end, unit, camera frame
  Eigen::ArrayXf length;  ///< angle between both ends [rad]
  std::vector<Eigen::Vector3d> normal_w;
  std::vector<Eigen::Vector3d> start_w, end_w;
  std::vector<char> taken;       ///< belongs to a line
  double near_m = 0, far_m = 0;  ///< between which a line is looked for
};

}  // namespace lintel
