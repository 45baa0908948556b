// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>

#include "lintel/estimator/SlidingWindow.h"
#include "solver/ReducedSystem.h"

namespace lintel {

/// Schur complement [Sibley2010]: what the residuals say about the blocks that stay once those in `dropped` are gone.
/// All points and lines go, in `dropped` or not; those that are eliminated one by one first, then the others
/// together with the states in `dropped`; directions without information are left
/// out. Empty when nothing stays.
std::optional<WindowPrior> marginalise(SlidingWindow& window, const std::vector<Factor>& factors,
                                       const std::set<BlockKey>& dropped);

}  // namespace lintel
