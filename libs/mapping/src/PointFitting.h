// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/KeyframeCameras.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

struct PointFitParams {
  double sigma_px = 1.0;
  double loss_width = 1.5;    ///< Cauchy, in standard deviations
  double max_error_px = 3.0;  ///< a view farther off is an outlier
  double min_depth_m = 0.1, max_depth_m = 200;
};

/// Estimates a point from all its views with fixed cameras, outliers marked. False (and `known` false) when fewer than
/// two views agree or it is not in front of the cameras.
bool fitPoint(const KeyframeCameras& cameras, const PointFitParams& params, PointRecord& point);

/// Distance [px] of a view from the projected point; infinity behind the camera.
double viewError(const KeyframeCameras& cameras, const Eigen::Vector3d& p_w, const PointView& view);

}  // namespace lintel
