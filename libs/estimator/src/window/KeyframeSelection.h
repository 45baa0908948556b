// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Whether the second-newest frame shows enough new to stay: parallax to the frame before it, few shared points, or
/// much time [Qin2018].
bool secondNewestIsKeyframe(const SlidingWindow& window, const EstimatorParams& params);

/// Whether nothing has moved between the two newest frames, for the images, the IMU and the estimate.
bool isAtRest(const SlidingWindow& window, const EstimatorParams& params);

int pointsInNewest(const SlidingWindow& window);
int linesInNewest(const SlidingWindow& window);

}  // namespace lintel
