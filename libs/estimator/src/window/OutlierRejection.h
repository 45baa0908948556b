// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Tracks whose reprojection contradicts the window: they are not triangulated any more and, as long as their sightings
/// stay in the window, will be tried again only with new ones. Returns the number of tracks rejected.
int rejectOutliers(SlidingWindow& window, const LandmarkParams& params);

}  // namespace lintel
