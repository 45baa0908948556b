// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Two-way marginalisation [Qin2018]: which residuals go with a frame that leaves.

/// The oldest frame with the points it hosts, the lines it sees, its IMU and the priors on it become a prior.
/// Leaves the frame itself in the window (removeFrame follows).
void marginaliseOldest(SlidingWindow& window, const EstimatorParams& params);

/// The second-newest frame is dropped with its images; only what priors knew about it is kept. Its IMU is joined to the
/// newest frame's. Leaves the frame itself in the window.
void marginaliseSecondNewest(SlidingWindow& window);

}  // namespace lintel
