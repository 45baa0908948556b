// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "lintel/mapping/KeyframeCameras.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// Where a line comes nearest to a viewing ray.
struct NearestToRay {
  double sine2 = 0;    ///< squared sine of the angle between both
  double along_m = 0;  ///< on the line, from its middle
  double depth_m = 0;  ///< on the ray, from the camera; not positive: the line is behind it
};

/// `ray_w`: a unit vector from the camera's centre `p_w_c`.
NearestToRay nearestToRay(const LineEstimate& line, const Eigen::Vector3d& p_w_c, const Eigen::Vector3d& ray_w);

/// Distance [px] of a view's farther end from the projected line; infinity when the line is not in front of the camera.
double viewError(const KeyframeCameras& cameras, const LineEstimate& line, const LineView& view);

/// Where on the line a view's ends lie, metres from the middle, and how far a pixel moves them along it [m].
struct ViewStretch {
  double start = 0, end = 0;
  double start_m_per_px = 0, end_m_per_px = 0;
};

/// Empty when that cannot be said: behind the camera, or at a grazing angle, where a small error of the direction moves
/// the place far.
std::optional<ViewStretch> viewStretch(const KeyframeCameras& cameras, const LineEstimate& line, const LineView& view);

}  // namespace lintel
