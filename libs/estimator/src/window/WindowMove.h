// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Places the whole window anew in the world: poses, velocities, and points and lines that are triangulated. `T` turns
/// about the vertical and shifts, which no measurement sees; biases, calibration and sightings stay as they are. Priors
/// on poses must not be there yet.
void moveWindow(SlidingWindow& window, const Pose& T);

}  // namespace lintel
