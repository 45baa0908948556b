// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "lintel/geometry/PinholeRadtan.h"

namespace lintel {

/// Where the normalised point `x0` of frame 0 is seen in frame 1 when the camera only turned [px]; far outside the
/// image when it is behind the camera.
inline cv::Point2f turnedPixel(const PinholeRadtan& camera, const Eigen::Quaterniond& R_c1_c0,
                               const Eigen::Vector2d& x0) {
  const Eigen::Vector3d f1 = R_c1_c0 * x0.homogeneous();
  if (f1.z() < 0.1) return {-1e4f, -1e4f};
  const Eigen::Vector2d px = camera.toPixel(f1.head<2>() / f1.z());
  return {static_cast<float>(px.x()), static_cast<float>(px.y())};
}

}  // namespace lintel
