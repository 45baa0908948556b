// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "lintel/geometry/Camera.h"
#include "lintel/geometry/Segment.h"

namespace lintel {

/// Whether a camera sees points: far enough away, inside its image, and within the radius for which its distortion
/// holds.
class ViewTest {
 public:
  explicit ViewTest(const Camera& camera, double border_px = 0, double min_depth_m = 0.2);

  /// The pixel of a point in the camera frame [m]; empty where it is not seen.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c) const;

  const Camera& camera() const { return camera_; }

 private:
  Camera camera_;
  double border_px_, min_depth_m_, least_cosine_;  ///< the last of the largest angle to the optical axis
};

/// The part of a segment that is inside the image: its ends in the camera frame [m] and in pixels, in the order of the
/// segment's own ends. Occlusion is not considered.
struct SegmentView {
  Segment3 visible_c;
  Eigen::Vector2d start_px = Eigen::Vector2d::Zero(), end_px = Eigen::Vector2d::Zero();

  double length_px() const { return (end_px - start_px).norm(); }
};

/// The longest visible run of a segment in the camera frame; empty where nothing of it is seen.
std::optional<SegmentView> viewSegment(const ViewTest& view, const Segment3& segment_c);

}  // namespace lintel
