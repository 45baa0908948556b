// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "solver/Factor.h"

namespace lintel {

/// Two-way marginalisation [Qin2018]: which residuals go with a frame that leaves.

/// The oldest frame leaves with the points and lines that it sees. Those of the window's `measurements` that touch what
/// leaves become a prior, with the priors on it; but not those that also touch a point or line that stays, or a shared
/// direction, nor what the newest frame sees: the tracks that go on start anew with that. Lasting points (at most
/// LandmarkParams::lasting_points) stay in the prior, with all their other sightings to come. `scale_walk`: standard
/// deviation of the logarithm of the scale that the prior loses. Leaves the frame itself in the window (removeFrame
/// follows).
void marginaliseOldest(SlidingWindow& window, const std::vector<Factor>& measurements, const LandmarkParams& params,
                       double scale_walk = 0);

/// The same with the measurements that WindowFactors makes.
void marginaliseOldest(SlidingWindow& window, const EstimatorParams& params, double scale_walk = 0);

/// The second-newest frame is dropped with its images; only what priors knew about it is kept. Its IMU is joined to the
/// newest frame's. Leaves the frame itself in the window.
void marginaliseSecondNewest(SlidingWindow& window);

}  // namespace lintel
