// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "landmarks/CameraPoses.h"
#include "lintel/estimator/EstimatorParams.h"

namespace lintel {

/// Inverse depth of a point from all its sightings with the window's poses: linear start, Gauss-Newton on the
/// rays. Sets point, origin_w, sigma_inverse_depth and triangulated; a point whose depth is not yet
/// known to point_max_relative_sigma waits: linearised at a wrong depth it would add information about translations
/// that it does not have. Returns false when it waits, lies behind a camera or its error is too large.
bool triangulatePoint(const CameraPoses& poses, const LandmarkParams& params, double sigma_px, PointTrack& track);

/// Triangulates every track with enough sightings that is not yet.
void triangulatePoints(SlidingWindow& window, const LandmarkParams& params, double sigma_px);

/// Lowers sigma_inverse_depth to what the present sightings give.
void updatePointUncertainty(const CameraPoses& poses, double sigma_px, PointTrack& track);

/// Mean reprojection error over the sightings, in pixels; infinity when behind a camera.
double reprojectionError(const CameraPoses& poses, const PointTrack& track);

}  // namespace lintel
