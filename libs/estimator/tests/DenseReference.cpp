// SPDX-License-Identifier: BSD-3-Clause
#include "DenseReference.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

namespace lintel::test {

namespace {

/// Residuals and tangent Jacobians of one factor, weighted by its loss (the first-order part of Triggs' correction).
struct LinearFactor {
  Eigen::VectorXd residual;
  std::vector<Eigen::MatrixXd> jacobians;
};

double robustSquare(const Factor& factor, double squared) {
  if (!factor.loss) return squared;
  double rho[3];
  factor.loss->Evaluate(squared, rho);
  return rho[0];
}

/// Weights of tracks by their landmarks: of Student's t distribution, (freedom + n) / (freedom + sum of squares), n the
/// number of residuals less the dimensions of the landmark.
std::map<BlockKey, double> trackWeights(SlidingWindow& window, const std::vector<Factor>& factors) {
  std::map<BlockKey, double> squares, count, weights;
  for (const Factor& factor : factors) {
    if (std::isinf(factor.track_freedom)) continue;
    std::vector<const double*> blocks;
    for (const BlockKey& key : factor.blocks) blocks.push_back(window.block(key));
    Eigen::VectorXd r(factor.cost->num_residuals());
    factor.cost->Evaluate(blocks.data(), r.data(), nullptr);
    const BlockKey& landmark = factor.blocks.back();
    squares[landmark] += robustSquare(factor, r.squaredNorm());
    count[landmark] += static_cast<double>(r.size());
  }
  for (const Factor& factor : factors) {
    if (std::isinf(factor.track_freedom)) continue;
    const BlockKey& landmark = factor.blocks.back();
    const double n = count[landmark] - manifoldOf(landmark.kind)->TangentSize();
    weights[landmark] = (factor.track_freedom + n) / (factor.track_freedom + squares[landmark]);
  }
  return weights;
}

LinearFactor lineariseFactor(SlidingWindow& window, const Factor& factor, double track_weight) {
  const ceres::CostFunction& cost = *factor.cost;
  const int rows = cost.num_residuals();
  std::vector<const double*> blocks;
  std::vector<RowMajorMatrix> ambient;
  std::vector<double*> pointers;
  for (std::size_t i = 0; i < factor.blocks.size(); ++i) {
    blocks.push_back(window.block(factor.blocks[i]));
    ambient.emplace_back(rows, cost.parameter_block_sizes()[i]);
  }
  pointers.reserve(ambient.size());
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
  weight *= std::sqrt(track_weight);
  result.residual *= weight;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto manifold = manifoldOf(factor.blocks[i].kind);
    RowMajorMatrix plus(manifold->AmbientSize(), manifold->TangentSize());
    manifold->PlusJacobian(blocks[i], plus.data());
    result.jacobians.push_back(weight * ambient[i] * plus);
  }
  return result;
}

}  // namespace

NormalEquations linearise(SlidingWindow& window, const std::vector<Factor>& factors, const std::set<BlockKey>& first) {
  // order: landmarks to drop, other blocks to drop, the rest
  std::set<BlockKey, decltype(&comesBefore)> all(&comesBefore);
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
  const std::map<BlockKey, double> weights = trackWeights(window, factors);
  for (const Factor& factor : factors) {
    const auto weight = std::isinf(factor.track_freedom) ? weights.end() : weights.find(factor.blocks.back());
    const LinearFactor f = lineariseFactor(window, factor, weight == weights.end() ? 1 : weight->second);
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

Eigen::MatrixXd solved(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) { return A.ldlt().solve(B); }

NormalEquations withoutFirst(const NormalEquations& equations, Eigen::Index m) {
  const Eigen::Index n = equations.H.rows() - m;
  NormalEquations rest;
  for (std::size_t i = 0; i < equations.offsets.size(); ++i) {
    if (equations.offsets[i] < m) continue;
    rest.offsets.push_back(equations.offsets[i] - m);
    if (i < equations.blocks.size()) rest.blocks.push_back(equations.blocks[i]);
  }
  const Eigen::LDLT<Eigen::MatrixXd> first(equations.H.topLeftCorner(m, m));
  const Eigen::MatrixXd gain = first.solve(equations.H.topRightCorner(m, n)).transpose();
  rest.H = equations.H.bottomRightCorner(n, n) - gain * equations.H.topRightCorner(m, n);
  rest.b = equations.b.tail(n) - gain * equations.b.head(m);
  return rest;
}

double solveWithCeres(SlidingWindow& window, const std::vector<Factor>& factors) {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  for (const Factor& factor : factors) {
    std::vector<double*> blocks;
    for (const BlockKey& key : factor.blocks) {
      const auto manifold = manifoldOf(key.kind);
      const bool curved = manifold->AmbientSize() != manifold->TangentSize();
      blocks.push_back(window.block(key));
      problem.AddParameterBlock(blocks.back(), manifold->AmbientSize(),
                                curved ? const_cast<StateManifold*>(manifold.get()) : nullptr);
    }
    problem.AddResidualBlock(const_cast<ceres::CostFunction*>(factor.cost),
                             const_cast<ceres::LossFunction*>(factor.loss), blocks);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = 100;
  solver.function_tolerance = solver.gradient_tolerance = solver.parameter_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary.final_cost;
}

}  // namespace lintel::test
