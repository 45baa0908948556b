// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

/// How many points and lines the window has, by what became of them; how far away the points are.
void countLandmarks(const SlidingWindow& window, const DegeneracyParams& params, WindowUpdate& update);

}  // namespace lintel
