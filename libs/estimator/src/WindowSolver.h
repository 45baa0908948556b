// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "WindowFactors.h"
#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

struct SolveSummary {
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;
  bool usable = false;
};

/// Minimises the given residuals over all blocks of the window they touch: Levenberg-Marquardt on ReducedSystem. One
/// thread and a limit on iterations, not on time: the same result every run.
SolveSummary solveWindow(SlidingWindow& window, const std::vector<Factor>& factors, const CalibrationParams& calibration,
                         int max_iterations);

}  // namespace lintel
