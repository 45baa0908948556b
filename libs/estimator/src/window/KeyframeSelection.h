// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Whether the second-newest frame shows enough new to stay: parallax to the frame before it, few shared points, or
/// much time [Qin2018]; and whether a rest begins or ends with it.
bool secondNewestIsKeyframe(const SlidingWindow& window, const EstimatorParams& params);

int pointsInNewest(const SlidingWindow& window);
int linesInNewest(const SlidingWindow& window);

}  // namespace lintel
