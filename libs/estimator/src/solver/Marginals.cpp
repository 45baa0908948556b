// SPDX-License-Identifier: BSD-3-Clause
#include "solver/Marginals.h"

#include <algorithm>

#include "solver/SparseCholesky.h"

namespace lintel {

Marginals::Marginals(const NormalEquations& equations, double floor)
    : blocks_(equations.blocks), offsets_(equations.offsets), L_(equations.H) {
  L_.diagonal().array() += floor;
  ok_ = factoriseSparse(L_);
}

Eigen::Index Marginals::offsetOf(const BlockKey& key) const {
  const auto found = std::find(blocks_.begin(), blocks_.end(), key);
  return found == blocks_.end() ? -1 : offsets_[static_cast<std::size_t>(found - blocks_.begin())];
}

Eigen::VectorXd Marginals::sigmas(const BlockKey& key) const {
  const Eigen::Index at = offsetOf(key);
  if (at < 0) return {};
  const Eigen::Index size = manifoldOf(key.kind)->TangentSize(), below = L_.rows() - at;
  // H^-1 = L^-T L^-1; rows of L^-1 unit above `at` are zero
  Eigen::MatrixXd half = Eigen::MatrixXd::Identity(below, size);
  L_.bottomRightCorner(below, below).triangularView<Eigen::Lower>().solveInPlace(half);
  return half.colwise().norm();
}

Eigen::MatrixXd Marginals::halves(const Eigen::MatrixXd& F_transposed) const {
  Eigen::Index from = 0;  // above, L^-1 F' is zero as F' is
  while (from < F_transposed.rows() && F_transposed.row(from).isZero(0)) ++from;
  const Eigen::Index below = F_transposed.rows() - from;
  Eigen::MatrixXd halves = F_transposed;
  L_.bottomRightCorner(below, below).triangularView<Eigen::Lower>().solveInPlace(halves.bottomRows(below));
  return halves;
}

double Marginals::variance(const Eigen::VectorXd& direction) const {
  return L_.triangularView<Eigen::Lower>().solve(direction).squaredNorm();
}

}  // namespace lintel
