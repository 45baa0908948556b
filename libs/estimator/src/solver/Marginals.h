// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "solver/ReducedSystem.h"

namespace lintel {

/// Marginal variances from the information of a window: the diagonal of its inverse, as far as it is asked for.
class Marginals {
 public:
  /// `floor` is added to the diagonal: instead of an inverse that fails, a sigma of 1/sqrt(floor).
  Marginals(const NormalEquations& equations, double floor);

  /// False when the information is not positive (and the functions below must not be called).
  bool ok() const { return ok_; }

  Eigen::Index size() const { return L_.rows(); }

  /// Where the block begins in the equations' tangent space; negative when the problem has no such block.
  Eigen::Index offsetOf(const BlockKey& key) const;

  /// Standard deviations of a block; empty when the problem has no such block.
  Eigen::VectorXd sigmas(const BlockKey& key) const;

  /// The variance of direction' dx.
  double variance(const Eigen::VectorXd& direction) const;

  /// L^-1 F': the covariance of F dx and G dx is halves(F')' halves(G').
  Eigen::MatrixXd halves(const Eigen::MatrixXd& F_transposed) const;

 private:
  std::vector<BlockKey> blocks_;
  std::vector<Eigen::Index> offsets_;
  Eigen::MatrixXd L_;  // lower triangle, L L' = H
  bool ok_ = false;
};

}  // namespace lintel
