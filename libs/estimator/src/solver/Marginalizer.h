// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>

#include "lintel/estimator/SlidingWindow.h"
#include "solver/ReducedSystem.h"

namespace lintel {

/// What stays and changes from one prior to the next.
struct Staying {
  std::set<BlockKey> points;
  double walk_rad = 0;  ///< standard deviation of a point's direction, as from its origin: they slide on their surfaces
  double bias_walk = 0;   ///< of the mean bias [m/s^2]
  double scale_walk = 0;  ///< of the logarithm of the scale: of all distances and velocities alike
};

/// Schur complement [Sibley2010]: what the residuals say about the blocks that stay once those in `dropped` are gone.
/// All points and lines but the staying ones go, in `dropped` or not; those that are eliminated one by one first, then
/// the others together with the states in `dropped`; directions without information are left out. Empty when nothing
/// stays.
std::optional<WindowPrior> marginalise(SlidingWindow& window, const std::vector<Factor>& factors,
                                       const std::set<BlockKey>& dropped, const Staying& staying = {});

}  // namespace lintel
