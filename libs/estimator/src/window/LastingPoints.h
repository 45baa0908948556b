// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "solver/Factor.h"

namespace lintel {

// Points whose tracks outlast the window stay among the states: marginalisation leaves them in the prior, and what
// earlier frames knew about them reaches the frames to come. The other tracks start anew when their oldest frame
// leaves.

/// The points that priors know.
std::set<BlockKey> pointsInPriors(const SlidingWindow& window);

/// The points that stay when the oldest frame leaves, all with residuals as small as their sigma says: those in priors
/// that the newest frame sees, and, up to LandmarkParams::lasting_points, those that the oldest and the newest frame
/// see, in three quarters of the window's frames at least, with a depth known to a twentieth; the best first.
std::set<BlockKey> lastingPoints(SlidingWindow& window, const std::vector<Factor>& measurements,
                                 const LandmarkParams& params);

}  // namespace lintel
