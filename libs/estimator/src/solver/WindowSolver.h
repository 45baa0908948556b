// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "solver/Factor.h"
#include "solver/ReducedSystem.h"

namespace lintel {

struct SolveSummary {
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;
  ResidualLevels levels;        ///< before the first step
  NormalEquations information;  ///< of the states, at the last linearisation and without damping; if asked for
};

/// When a solve has had enough.
struct SolveLimits {
  int max_iterations = 8;
  double min_move = 0;  ///< of the states by a step, see ReducedSystem::statesMove; landmarks may still be on their way
  bool information = false;  ///< whether SolveSummary::information is wanted
  /// Relative decrease of the cost by a step after which no other is worth it. The window's next frame goes on from
  /// here: with 1e-3 it takes a fifth more steps, and trajectories are no better.
  double tolerance = 3e-3;
  /// Times the diagonal of the normal equations. It shortens steps along what is known a thousand times less well
  /// together with the other states than by itself, as biases are: such states follow over many solves.
  double first_damping = 1e-4;
};

/// Makes constants of what is not refined of the calibration.
void holdCalibration(ReducedSystem& system, const CalibrationParams& calibration);

/// Minimises the given residuals over all blocks of the window they touch: Levenberg-Marquardt on ReducedSystem. One
/// thread and a limit on iterations, not on time: the same result every run.
SolveSummary solveWindow(SlidingWindow& window, const std::vector<Factor>& factors,
                         const CalibrationParams& calibration, const SolveLimits& limits);

}  // namespace lintel
