// SPDX-License-Identifier: BSD-3-Clause
#include "DenseReference.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace lintel::test {

namespace {

/// Residuals of one factor and their Jacobian with respect to all states of the equations, without its loss.
struct LinearFactor {
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
};

double lossWeight(const ceres::LossFunction* loss, double squared, double& robust_square) {
  double rho[3] = {squared, 1, 0};
  if (loss) loss->Evaluate(squared, rho);
  robust_square = rho[0];
  return rho[1];
}

LinearFactor lineariseFactor(SlidingWindow& window, const Factor& factor,
                             const std::map<BlockKey, Eigen::Index>& offset, Eigen::Index size) {
  // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a factor has a cost
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
  LinearFactor result{Eigen::VectorXd(rows), Eigen::MatrixXd::Zero(rows, size)};
  cost.Evaluate(blocks.data(), result.residual.data(), pointers.data());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto manifold = manifoldOf(factor.blocks[i].kind);
    RowMajorMatrix plus(manifold->AmbientSize(), manifold->TangentSize());
    manifold->PlusJacobian(blocks[i], plus.data());
    result.jacobian.middleCols(offset.at(factor.blocks[i]), manifold->TangentSize()) += ambient[i] * plus;
  }
  return result;
}

/// The covariance of a track's errors by TrackNoise's comment, of all residuals.
Eigen::MatrixXd covarianceOf(const NoiseKind& kind, const std::vector<double>& t_s, Eigen::Index rows) {
  const auto count = static_cast<Eigen::Index>(t_s.size());
  Eigen::MatrixXd covariance(count * rows, count * rows);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      covariance.block(rows * i, rows * j, rows, rows) =
          Eigen::MatrixXd::Identity(rows, rows) *
          ((i == j ? kind.white * kind.white : 0) +
           kind.walk * kind.walk * (t_s[static_cast<std::size_t>(std::min(i, j))] - t_s.front()));
  return covariance;
}

/// Weights of the residuals of a track that are independent already: the loss of each sighting and of all of them,
/// Student's t distribution with weights (freedom + n) / (freedom + sum of squares), n the number of residuals less the
/// dimensions of the landmark. Gives minus the logarithm of their density.
Eigen::VectorXd weightsOf(const Factor& factor, double freedom, const Eigen::VectorXd& r, Eigen::Index rows,
                          double& cost) {
  double squares = 0, square;
  Eigen::VectorXd weights(r.size());
  for (Eigen::Index i = 0; i < r.size(); i += rows) {
    weights.segment(i, rows).setConstant(lossWeight(factor.loss, r.segment(i, rows).squaredNorm(), square));
    squares += square;
  }
  cost = 0.5 * squares;
  if (std::isinf(freedom)) return weights;
  const double n = static_cast<double>(r.size()) - manifoldOf(factor.blocks.back().kind)->TangentSize();
  cost = 0.5 * (freedom + n) * std::log(1 + squares / freedom);
  return weights * (freedom + n) / (freedom + squares);
}

/// Of all factors of a track, one below the other: made independent by the Cholesky factor of their covariance, by the
/// kind of noise that makes them likeliest.
void addTrack(const SlidingWindow& window, const std::vector<const Factor*>& factors,
              const std::vector<LinearFactor>& sightings, NormalEquations& eq) {
  const auto count = static_cast<Eigen::Index>(factors.size()), rows = sightings.front().residual.size();
  std::vector<double> t_s;
  Eigen::MatrixXd all_J(count * rows, eq.H.cols()), J;
  Eigen::VectorXd all_r(count * rows), r, weights;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    t_s.push_back(1e-9 *
                  static_cast<double>(window.frame(factors[at]->blocks.front().id).t_ns - window.frames.front().t_ns));
    all_r.segment(rows * i, rows) = sightings[at].residual;
    all_J.middleRows(rows * i, rows) = sightings[at].jacobian;
  }
  const double n = static_cast<double>(all_r.size());
  const double share = std::max(1.0, n - manifoldOf(factors.front()->blocks.back().kind)->TangentSize()) / n;
  double least = std::numeric_limits<double>::infinity(), cost;
  for (const NoiseKind& kind : factors.front()->noise->kinds) {
    const Eigen::LLT<Eigen::MatrixXd> llt(covarianceOf(kind, t_s, rows));
    const Eigen::VectorXd whitened = llt.matrixL().solve(all_r);
    const Eigen::VectorXd w = weightsOf(*factors.front(), factors.front()->noise->freedom, whitened, rows, cost);
    cost += share * llt.matrixLLT().diagonal().array().log().sum();
    if (cost >= least) continue;
    least = cost;
    r = whitened;
    J = llt.matrixL().solve(all_J);
    weights = w;
  }
  eq.H += J.transpose() * weights.asDiagonal() * J;
  eq.b += J.transpose() * weights.asDiagonal() * r;
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
  std::map<BlockKey, std::vector<const Factor*>> tracks;
  for (const Factor& factor : factors) {
    if (isImageFactor(factor) && isLandmark(factor.blocks.back())) {
      tracks[factor.blocks.back()].push_back(&factor);
      continue;
    }
    const LinearFactor f = lineariseFactor(window, factor, offset, size);
    double square;
    const double weight = lossWeight(factor.loss, f.residual.squaredNorm(), square);
    eq.H += weight * f.jacobian.transpose() * f.jacobian;
    eq.b += weight * f.jacobian.transpose() * f.residual;
  }
  for (const auto& [landmark, sighted] : tracks) {
    std::vector<LinearFactor> sightings;
    sightings.reserve(sighted.size());
    for (const Factor* factor : sighted) sightings.push_back(lineariseFactor(window, *factor, offset, size));
    addTrack(window, sighted, sightings, eq);
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
