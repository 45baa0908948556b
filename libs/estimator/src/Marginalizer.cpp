// SPDX-License-Identifier: BSD-3-Clause
#include "Marginalizer.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace lintel {

namespace {

constexpr double kNoInformation = 1e-8;  // eigenvalues below are taken as zero, relative to a residual of one sigma

/// Symmetric pseudo-inverse; directions with less information than kNoInformation are left out.
Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (m + m.transpose()));
  const Eigen::VectorXd inverse =
      solver.eigenvalues().unaryExpr([](double v) { return v > kNoInformation ? 1.0 / v : 0.0; });
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

/// H and b without rows [at, at + size), their information passed on to the others.
void eliminate(NormalEquations& eq, Eigen::Index at, Eigen::Index size) {
  const Eigen::Index rest = eq.H.rows() - at - size;
  if (size == 0 || rest == 0) return;
  const auto Hbm = eq.H.block(at + size, at, rest, size);
  const Eigen::MatrixXd gain = Hbm * pseudoInverse(eq.H.block(at, at, size, size));
  eq.b.tail(rest) -= gain * eq.b.segment(at, size);
  eq.H.bottomRightCorner(rest, rest) -= gain * Hbm.transpose();
}

}  // namespace

std::optional<WindowPrior> marginalise(SlidingWindow& window, const std::vector<Factor>& factors,
                                       const std::set<BlockKey>& dropped) {
  ReducedSystem system(window, factors, dropped, {});
  system.linearise();
  NormalEquations eq = system.eliminate();
  std::size_t kept = 0;
  while (kept < eq.blocks.size() && dropped.count(eq.blocks[kept]) > 0) ++kept;
  const Eigen::Index start = eq.offsets[kept], size = eq.H.rows() - start;
  if (size == 0) return std::nullopt;
  eliminate(eq, 0, start);

  // H = S S^T with S = V sqrt(D): the prior's residual is S^T dx + S^+ b
  const Eigen::MatrixXd H = eq.H.bottomRightCorner(size, size);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (H + H.transpose()));
  const Eigen::VectorXd& d = solver.eigenvalues();
  Eigen::Index zero = 0;
  while (zero < size && d[zero] <= kNoInformation) ++zero;
  const Eigen::VectorXd root = d.tail(size - zero).cwiseSqrt();
  const Eigen::MatrixXd Vt = solver.eigenvectors().rightCols(size - zero).transpose();
  WindowPrior prior;
  std::vector<PriorBlock> blocks;
  for (std::size_t i = kept; i < eq.blocks.size(); ++i) {
    const auto manifold = manifoldOf(eq.blocks[i].kind);
    prior.blocks.push_back(eq.blocks[i]);
    blocks.push_back({manifold, Eigen::Map<const Eigen::VectorXd>(window.block(eq.blocks[i]), manifold->AmbientSize())});
  }
  prior.factor = std::make_shared<PriorFactor>(std::move(blocks), root.asDiagonal() * Vt,
                                               root.cwiseInverse().asDiagonal() * (Vt * eq.b.tail(size)));
  return prior;
}

}  // namespace lintel
