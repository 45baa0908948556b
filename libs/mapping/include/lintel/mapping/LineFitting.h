// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/KeyframeCameras.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// How lines are fitted to their views.
struct LineFitParams {
  double loss_width = 1.5;    ///< Cauchy, in standard deviations of a view
  double max_error_px = 3.0;  ///< an end farther from the projected line makes its view an outlier
  double min_depth_m = 0.1;
  double systematic = 0.3;  ///< error that all views of a line have in common (a shaded or round edge), in their sigmas
};

/// Estimates a line from all its views with fixed cameras: start from the planes through camera and view (or from the
/// former estimate, whichever fits better), robust refinement, outliers marked. Sets everything of `line` but id and
/// group. False (and `known` false) when fewer than two views in different keyframes agree.
///
/// With middle m, unit direction d and a basis B across d, the residual (LineDistances.h) is that of
///   l = R_c_w ((m - p_w_c) x d),   m <- m + B a,  d <- d + B b
/// so that the covariance of (a, b) is in metres and radians.
bool fitLine(const KeyframeCameras& cameras, const LineFitParams& params, LineRecord& line);

}  // namespace lintel
