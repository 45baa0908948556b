// SPDX-License-Identifier: BSD-3-Clause
// How the factors come into ReducedSystem's normal equations: the larger half of its class to compile.
#include <cmath>
#include <cstdint>
#include <numeric>

#include "solver/ReducedSystem.h"

namespace lintel {

namespace {

/// Where the tangent space is the space itself, and its Jacobians are identities.
bool isVectorSpace(const StateManifold& manifold) { return manifold.AmbientSize() == manifold.TangentSize(); }

}  // namespace

double ReducedSystem::linearise() {
  const Eigen::Index n = states_.offsets.back();
  states_.H.setZero(n, n);
  states_.b.setZero(n);
  double sum = 0;
  for (const Factor* factor : landmarks_.others()) {
    const auto* prior = dynamic_cast<const PriorFactor*>(factor->cost);
    sum += prior && !factor->loss ? addPrior(*factor, *prior) : addOther(*factor);
  }
  views_ = views(true);
  return sum + landmarks_.linearise(views_);
}

double ReducedSystem::addOther(const Factor& factor) {
  // NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage): a factor has a cost
  const int rows = factor.cost->num_residuals();
  const std::vector<std::int32_t>& sizes = factor.cost->parameter_block_sizes();
  auto& [blocks, ambient, numbers, r, J, H] = other_;
  numbers.resize(static_cast<std::size_t>(rows * std::accumulate(sizes.begin(), sizes.end(), 0)));
  blocks.clear();
  ambient.clear();
  double* next = numbers.data();
  for (std::size_t i = 0; i < factor.blocks.size(); ++i) {
    blocks.push_back(window_.block(factor.blocks[i]));
    ambient.push_back(next);
    next += rows * sizes[i];
  }
  r.resize(rows);
  factor.cost->Evaluate(blocks.data(), r.data(), ambient.data());
  const Placement to = placementOf(factor);
  J.resize(rows, to.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const StateManifold& manifold = *manifoldOf(factor.blocks[i].kind);
    const Eigen::Map<const RowMajorMatrix> by_block(ambient[i], rows, sizes[i]);
    auto of_block = J.middleCols(to.from[i], manifold.TangentSize());
    if (isVectorSpace(manifold)) {
      of_block = by_block;
      continue;
    }
    RowMajorMatrix plus(manifold.AmbientSize(), manifold.TangentSize());
    manifold.PlusJacobian(blocks[i], plus.data());
    of_block = by_block.lazyProduct(plus);
  }
  double weight;
  const double cost = robustCost(factor.loss, r.squaredNorm(), weight);
  if (factor.loss) {
    J *= std::sqrt(weight);
    r *= std::sqrt(weight);
  }
  H.noalias() = J.transpose() * J;
  addInformation(to, H, J.transpose() * r);
  return cost;
}

namespace {

/// C' from both sides on the rows and columns `at` of H, and on these rows of `a` and `b`.
template <int N>
void turnBlock(const Eigen::Matrix<double, N, N>& C, Eigen::Index at, Eigen::MatrixXd& H, Eigen::MatrixXd& a,
               Eigen::VectorXd& b) {
  const Eigen::Index n = C.cols();
  H.middleCols<N>(at, n) = H.middleCols<N>(at, n).lazyProduct(C).eval();
  H.middleRows<N>(at, n) = C.transpose().lazyProduct(H.middleRows<N>(at, n)).eval();
  a.middleRows<N>(at, n) = C.transpose().lazyProduct(a.middleRows<N>(at, n)).eval();
  b.segment<N>(at, n) = C.transpose().lazyProduct(b.segment<N>(at, n)).eval();
}

}  // namespace

/// A prior's information does not change, only the tangent spaces turn, and the alignment with its anchor moves:
/// H = C' A'A C with C = blocks on the diagonal + G E in the anchor's columns.
double ReducedSystem::addPrior(const Factor& factor, const PriorFactor& prior) {
  std::vector<const double*> blocks;
  for (const BlockKey& key : factor.blocks) blocks.push_back(window_.block(key));
  const PriorDifference difference = prior.difference(blocks.data(), true);
  const Eigen::VectorXd r = prior.constant() + prior.root() * difference.value;
  Eigen::VectorXd gradient = prior.root().transpose() * r;
  Eigen::MatrixXd H = prior.information();
  const Placement to = placementOf(factor);
  const Eigen::MatrixXd by_alignment = H * difference.by_alignment;  // n x 4, before the blocks turn
  const Eigen::Matrix4d square = difference.by_alignment.transpose() * by_alignment;
  const Eigen::Vector4d gradient_alignment = difference.by_alignment.transpose() * gradient;
  Eigen::MatrixXd turned = by_alignment;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Eigen::MatrixXd& C = difference.by_block[i];
    if (C.size() == 0) continue;
    if (C.cols() == kPointTangent)
      turnBlock<kPointTangent>(C, to.from[i], H, turned, gradient);
    else if (C.cols() == kPoseTangent)
      turnBlock<kPoseTangent>(C, to.from[i], H, turned, gradient);
    else
      turnBlock<Eigen::Dynamic>(C, to.from[i], H, turned, gradient);
  }
  if (prior.anchor() >= 0) {
    const Eigen::Index at = to.from[static_cast<std::size_t>(prior.anchor())];
    const Eigen::MatrixXd cross = turned * difference.alignment_by_anchor;  // n x 6
    H.middleCols<kPoseTangent>(at) += cross;
    H.middleRows<kPoseTangent>(at) += cross.transpose();
    H.block<kPoseTangent, kPoseTangent>(at, at) +=
        difference.alignment_by_anchor.transpose() * square * difference.alignment_by_anchor;
    gradient.segment<kPoseTangent>(at) += difference.alignment_by_anchor.transpose() * gradient_alignment;
  }
  addInformation(to, H, gradient);
  return 0.5 * r.squaredNorm();
}

ReducedSystem::Placement ReducedSystem::placementOf(const Factor& factor) const {
  Placement placement;
  for (const BlockKey& key : factor.blocks) {
    placement.to.push_back(offsetOf(key));
    placement.from.push_back(placement.from.back() + manifoldOf(key.kind)->TangentSize());
  }
  return placement;
}

void ReducedSystem::addInformation(const Placement& place, const Eigen::MatrixXd& H, const Eigen::VectorXd& b) {
  std::vector<RowRun> runs;  // blocks that follow each other on both sides at a time
  for (std::size_t i = 0; i < place.to.size(); ++i)
    if (place.to[i] >= 0) append({place.from[i], place.to[i], place.from[i + 1] - place.from[i]}, runs);
  for (const RowRun& row : runs) {
    states_.b.segment(row.to, row.size) += b.segment(row.from, row.size);
    for (const RowRun& column : runs)
      if (column.to <= row.to)
        states_.H.block(row.to, column.to, row.size, column.size) +=
            H.block(row.from, column.from, row.size, column.size);
  }
}

}  // namespace lintel
