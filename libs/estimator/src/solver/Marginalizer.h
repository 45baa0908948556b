// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>

#include "lintel/estimator/SlidingWindow.h"
#include "solver/ReducedSystem.h"

namespace lintel {

/// Points that stay, and how far each may slide on its surface from one prior to the next.
struct StayingPoints {
  std::set<BlockKey> keys;
  double walk_rad = 0;  ///< standard deviation of a point's direction, as from its origin
};

/// Schur complement [Sibley2010]: what the residuals say about the blocks that stay once those in `dropped` are gone.
/// All points and lines but the staying ones go, in `dropped` or not; those that are eliminated one by one first, then
/// the others together with the states in `dropped`; directions without information are left out. Empty when nothing
/// stays.
std::optional<WindowPrior> marginalise(SlidingWindow& window, const std::vector<Factor>& factors,
                                       const std::set<BlockKey>& dropped, const StayingPoints& staying = {});

}  // namespace lintel
