// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "window/WindowFactors.h"

namespace lintel {

/// How large the residuals are, in the standard deviations that were assumed; 1 where too few say anything.
struct ResidualScales {
  double points = 1, lines = 1;
};

/// From the medians of the residuals' norms at the window's present state, which outliers do not move; what the
/// landmarks' own freedom takes away from the residuals is given back.
ResidualScales residualScales(SlidingWindow& window, const std::vector<Factor>& factors);

/// Moves the sigmas of points and lines a little towards what their residuals say [METHOD, adaptive weights]; never
/// farther than twice or half of the configured ones.
void adaptSigmas(const ResidualScales& scales, const FactorParams& configured, FactorParams& now);

}  // namespace lintel
