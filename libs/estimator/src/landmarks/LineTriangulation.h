// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "landmarks/CameraPoses.h"
#include "lintel/estimator/EstimatorParams.h"
#include "window/WindowFactors.h"

namespace lintel {

/// A line from all its observation planes at once (the null space of their normals; for two planes the dual Plücker
/// matrix of [Lim2021, eq. dual_plucker]), refined on the line residual with the poses. Sets line, origin_w,
/// sigmas, verdict and triangulated. Returns false when it cannot be a line in front of the cameras; a degenerate
/// verdict then says that the reason may be a lack of information.
bool triangulateLine(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track);

/// The same for a line whose direction is known from its group, starting at `track.line`. Returns false, and leaves the
/// track as it was, when its distance does not become known or the line does not fit.
bool triangulateTied(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track,
                     const Eigen::Vector3d& d_w);

/// Triangulates every track with enough sightings that is not yet, or whose line was degenerate so far.
void triangulateLines(SlidingWindow& window, const EstimatorParams& params);

/// Updates sigmas and the degenerate flag of a triangulated line from all its sightings: LineDegeneracy.
void updateLineUncertainty(const CameraPoses& poses, const EstimatorParams& params, LineTrack& track);

/// Mean distance of the observed ends to the projected line, in pixels; infinity when the seen part is behind a camera.
double lineError(const CameraPoses& poses, const LineTrack& track);

/// The line in the world, moment about the world's origin.
PluckerLine lineInWorld(const LineTrack& track);

}  // namespace lintel
