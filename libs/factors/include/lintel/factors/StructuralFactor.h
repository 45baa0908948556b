// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "lintel/factors/StateBlocks.h"

namespace lintel {

/// What ties a line to a direction that others share. The window's solver eliminates such a line like one that only
/// images see, as long as one of these is on it. Blocks: line, direction.
using LineDirectionFactor = ceres::SizedCostFunction<3, kLineSize, kDirectionSize>;

/// Ties a line to the direction that its group shares ([Lim2021] structural constraint, in O(n) for n lines):
///
///   r = weight d_line x d_group,   d_line = U e2,   |r| = weight |sin angle|
///
/// Smooth where they are parallel, and zero too where they are opposite: a line has no sign. `weight` = 1 / sigma_rad.
/// Blocks: line, direction.
class SharedDirectionFactor final : public LineDirectionFactor {
 public:
  explicit SharedDirectionFactor(double weight) : weight_(weight) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double weight_;
};

/// The constraint as [Lim2021] writes it, r_S = d_i x d_j for a pair of lines: O(n^2) for n lines. The reference for
/// SharedDirectionFactor. Blocks: line i, line j.
class ParallelLinesFactor final : public ceres::SizedCostFunction<3, kLineSize, kLineSize> {
 public:
  explicit ParallelLinesFactor(double weight) : weight_(weight) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double weight_;
};

}  // namespace lintel
