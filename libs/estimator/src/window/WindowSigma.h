// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/Estimator.h"
#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Standard deviations of what outlives a window.
struct WindowSigma {
  CalibrationSigma calibration;  ///< zero for what is held
  ImuBias bias;                  ///< of the newest frame
};

/// How well the window knows calibration and biases: from the information of all that its problem knows, priors of the
/// rig included, with poses, velocities, points and lines marginalised. Costs about as much as an iteration of the
/// solver.
WindowSigma windowSigma(const SlidingWindow& window, const EstimatorParams& params, const Pose& T_b_c_calibrated);

}  // namespace lintel
