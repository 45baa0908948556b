// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "WindowFactors.h"
#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// A line from all its observation planes at once (the null space of their normals; for two planes the dual Plücker
/// matrix of [Lim2021, eq. dual_plucker]), refined on the line residual with the window's poses. Sets line, origin_w,
/// sigmas, degenerate and triangulated. Returns false when it cannot be a line in front of the cameras.
bool triangulateLine(const SlidingWindow& window, const EstimatorParams& params, LineTrack& track);

/// Triangulates every track with enough sightings that is not yet, or whose line was degenerate so far.
void triangulateLines(SlidingWindow& window, const EstimatorParams& params);

/// Updates sigmas and the degenerate flag of a triangulated line from all its sightings: LineDegeneracy.
void updateLineUncertainty(const SlidingWindow& window, const EstimatorParams& params, LineTrack& track);

/// Mean distance of the observed ends to the projected line, in pixels; infinity when the seen part is behind a camera.
double lineError(const SlidingWindow& window, const LineTrack& track);

/// The line in the world, moment about the world's origin.
PluckerLine lineInWorld(const LineTrack& track);

}  // namespace lintel
