// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <suitesparse/cholmod.h>

#include <Eigen/SparseCore>

namespace lintel {

/// The Cholesky factor of a large sparse symmetric matrix, P S P^T = L L^T, by CHOLMOD [Chen2008]: rows and columns are
/// ordered for few entries in L, and its columns are treated in dense blocks.
class SparseFactor {
 public:
  /// `lower`: the lower triangle of S.
  explicit SparseFactor(Eigen::SparseMatrix<double> lower);
  ~SparseFactor();
  SparseFactor(const SparseFactor&) = delete;
  SparseFactor& operator=(const SparseFactor&) = delete;

  /// Whether S is positive definite.
  bool usable() const { return usable_; }

  /// P^T L^-T z, a column for each of z: of independent normal numbers z it makes those of the covariance S^-1.
  Eigen::MatrixXd solveTransposed(Eigen::MatrixXd z) const;

 private:
  mutable cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  bool usable_ = false;
};

}  // namespace lintel
