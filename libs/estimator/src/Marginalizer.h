// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>

#include "WindowFactors.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// The normal equations of some residuals around the present estimate, in tangent spaces: H dx = -b.
struct NormalEquations {
  std::vector<BlockKey> blocks;          ///< in the order of H
  std::vector<Eigen::Index> offsets;     ///< of the blocks in H; one more entry for the end
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

/// Linearises the residuals (robust losses as weights). Blocks in `first` come first.
NormalEquations linearise(SlidingWindow& window, const std::vector<Factor>& factors, const std::set<BlockKey>& first);

/// Schur complement [Sibley2010]: what the residuals say about the blocks that stay once those in `dropped` are gone.
/// Points and lines are eliminated one by one, then the rest together; directions without information are left out.
/// Empty when nothing stays.
std::optional<WindowPrior> marginalise(SlidingWindow& window, const std::vector<Factor>& factors,
                                       const std::set<BlockKey>& dropped);

}  // namespace lintel
