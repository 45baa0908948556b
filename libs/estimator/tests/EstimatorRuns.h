// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "TestWindow.h"
#include "lintel/estimator/Estimator.h"

namespace lintel::test {

/// Everything an estimator said about a flight; the last update is finish()'s.
std::vector<WindowUpdate> run(const TrackedFlight& flight, const EstimatorParams& params = {}, bool lines = true);

/// Where the body was, by the causal trajectory and truly, wherever there is a pose [m].
struct Positions {
  std::vector<Eigen::Vector3d> estimate, truth;
};

Positions positionsOf(const std::vector<WindowUpdate>& updates, const TrackedFlight& flight);

/// Root mean square position error of the causal trajectory after alignment of position and yaw [m].
double positionError(const std::vector<WindowUpdate>& updates, const TrackedFlight& flight);

int posesOf(const std::vector<WindowUpdate>& updates);

int lostOf(const std::vector<WindowUpdate>& updates);

TrackSimulationParams tracksFor(double duration_s, double noise_px);

/// The calibration of a simulated flight is perfect: what is left of the error is the estimator's.
EstimatorParams withoutCalibration();

/// Keyframes are handed over once, landmarks once between two starts.
void expectEachIdOnce(const std::vector<WindowUpdate>& updates);

}  // namespace lintel::test
