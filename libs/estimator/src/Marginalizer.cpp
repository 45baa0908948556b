// SPDX-License-Identifier: BSD-3-Clause
#include "Marginalizer.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>

namespace lintel {

namespace {

constexpr double kNoInformation = 1e-8;  // eigenvalues below are taken as zero, relative to a residual of one sigma

/// Residuals and tangent Jacobians of one factor, weighted by its loss (the first-order part of Triggs' correction).
struct LinearFactor {
  Eigen::VectorXd residual;
  std::vector<Eigen::MatrixXd> jacobians;
};

LinearFactor lineariseFactor(SlidingWindow& window, const Factor& factor) {
  const ceres::CostFunction& cost = *factor.cost;
  const int rows = cost.num_residuals();
  std::vector<const double*> blocks;
  std::vector<RowMajorMatrix> ambient;
  std::vector<double*> pointers;
  for (std::size_t i = 0; i < factor.blocks.size(); ++i) {
    blocks.push_back(window.block(factor.blocks[i]));
    ambient.emplace_back(rows, cost.parameter_block_sizes()[i]);
  }
  for (RowMajorMatrix& m : ambient) pointers.push_back(m.data());
  LinearFactor result;
  result.residual.resize(rows);
  cost.Evaluate(blocks.data(), result.residual.data(), pointers.data());
  double weight = 1;
  if (factor.loss) {
    double rho[3];
    factor.loss->Evaluate(result.residual.squaredNorm(), rho);
    weight = std::sqrt(rho[1]);
  }
  result.residual *= weight;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto manifold = manifoldOf(factor.blocks[i].kind);
    RowMajorMatrix plus(manifold->AmbientSize(), manifold->TangentSize());
    manifold->PlusJacobian(blocks[i], plus.data());
    result.jacobians.push_back(weight * ambient[i] * plus);
  }
  return result;
}

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
  if (rest == 0) return;
  const auto Hbm = eq.H.block(at + size, at, rest, size);
  const Eigen::MatrixXd gain = Hbm * pseudoInverse(eq.H.block(at, at, size, size));
  eq.b.tail(rest) -= gain * eq.b.segment(at, size);
  eq.H.bottomRightCorner(rest, rest) -= gain * Hbm.transpose();
}

/// The same for a landmark, which touches few blocks only: the update is limited to the columns that are not zero.
void eliminateSparse(NormalEquations& eq, Eigen::Index at, Eigen::Index size, const std::vector<Eigen::Index>& touched) {
  const auto n = static_cast<Eigen::Index>(touched.size());
  Eigen::MatrixXd Hbm(n, size);
  for (Eigen::Index i = 0; i < n; ++i) Hbm.row(i) = eq.H.block(touched[static_cast<std::size_t>(i)], at, 1, size);
  const Eigen::MatrixXd gain = Hbm * pseudoInverse(eq.H.block(at, at, size, size));
  const Eigen::VectorXd db = gain * eq.b.segment(at, size);
  const Eigen::MatrixXd dH = gain * Hbm.transpose();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index row = touched[static_cast<std::size_t>(i)];
    eq.b[row] -= db[i];
    for (Eigen::Index j = 0; j < n; ++j) eq.H(row, touched[static_cast<std::size_t>(j)]) -= dH(i, j);
  }
}

}  // namespace

NormalEquations linearise(SlidingWindow& window, const std::vector<Factor>& factors, const std::set<BlockKey>& first) {
  // order: landmarks to drop, other blocks to drop, the rest
  std::set<BlockKey> all;
  for (const Factor& factor : factors) all.insert(factor.blocks.begin(), factor.blocks.end());
  NormalEquations eq;
  const auto append = [&](bool wanted_first, bool wanted_landmark) {
    for (const BlockKey& key : all) {
      const bool landmark = key.kind == BlockKey::kPoint || key.kind == BlockKey::kLine;
      if ((first.count(key) > 0) == wanted_first && (!wanted_first || landmark == wanted_landmark))
        eq.blocks.push_back(key);
    }
  };
  append(true, true);
  append(true, false);
  append(false, false);
  std::map<BlockKey, Eigen::Index> offset;
  Eigen::Index size = 0;
  for (const BlockKey& key : eq.blocks) {
    eq.offsets.push_back(size);
    offset[key] = size;
    size += manifoldOf(key.kind)->TangentSize();
  }
  eq.offsets.push_back(size);
  eq.H = Eigen::MatrixXd::Zero(size, size);
  eq.b = Eigen::VectorXd::Zero(size);
  for (const Factor& factor : factors) {
    const LinearFactor f = lineariseFactor(window, factor);
    for (std::size_t i = 0; i < factor.blocks.size(); ++i) {
      const Eigen::MatrixXd& Ji = f.jacobians[i];
      const Eigen::Index row = offset.at(factor.blocks[i]);
      eq.b.segment(row, Ji.cols()) += Ji.transpose() * f.residual;
      for (std::size_t j = 0; j < factor.blocks.size(); ++j) {
        const Eigen::MatrixXd& Jj = f.jacobians[j];
        eq.H.block(row, offset.at(factor.blocks[j]), Ji.cols(), Jj.cols()).noalias() += Ji.transpose() * Jj;
      }
    }
  }
  return eq;
}

std::optional<WindowPrior> marginalise(SlidingWindow& window, const std::vector<Factor>& factors,
                                       const std::set<BlockKey>& dropped) {
  NormalEquations eq = linearise(window, factors, dropped);
  std::size_t kept = 0;
  Eigen::Index others_at = -1;
  for (; kept < eq.blocks.size() && dropped.count(eq.blocks[kept]) > 0; ++kept) {
    const BlockKey::Kind kind = eq.blocks[kept].kind;
    if (kind != BlockKey::kPoint && kind != BlockKey::kLine) {
      if (others_at < 0) others_at = eq.offsets[kept];
      continue;
    }
    const Eigen::Index at = eq.offsets[kept], size = eq.offsets[kept + 1] - at;
    std::vector<Eigen::Index> touched;
    for (Eigen::Index row = at + size; row < eq.H.rows(); ++row)
      if (!eq.H.block(row, at, 1, size).isZero(0)) touched.push_back(row);
    eliminateSparse(eq, at, size, touched);
  }
  const Eigen::Index start = eq.offsets[kept], size = eq.H.rows() - start;
  if (size == 0) return std::nullopt;
  if (others_at >= 0) eliminate(eq, others_at, start - others_at);

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
