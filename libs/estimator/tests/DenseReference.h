// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "solver/ReducedSystem.h"

namespace lintel::test {

/// The normal equations of some residuals, every block in one dense matrix, by the factors' own Jacobians: slow and
/// plain, the reference for ReducedSystem. Blocks in `first` come first (points and lines before others).
NormalEquations linearise(SlidingWindow& window, const std::vector<Factor>& factors, const std::set<BlockKey>& first);

/// X of A X = B for a symmetric positive definite A; takes seconds to compile, so that it is done once for all tests.
Eigen::MatrixXd solved(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The equations of the blocks that are left when those of the first `m` rows are eliminated in one dense solve.
NormalEquations withoutFirst(const NormalEquations& equations, Eigen::Index m);

/// Minimises the residuals with Ceres on copies of the blocks, then writes them back; returns the final cost. The
/// reference for WindowSolver.
double solveWithCeres(SlidingWindow& window, const std::vector<Factor>& factors);

}  // namespace lintel::test
