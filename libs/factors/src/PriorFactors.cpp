// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/PriorFactors.h"

namespace lintel {

PriorFactor::PriorFactor(std::vector<PriorBlock> blocks, Eigen::MatrixXd A, Eigen::VectorXd r_0)
    : blocks_(std::move(blocks)), A_(std::move(A)), r_0_(std::move(r_0)), information_(A_.transpose() * A_) {
  for (const PriorBlock& block : blocks_) mutable_parameter_block_sizes()->push_back(block.manifold->AmbientSize());
  set_num_residuals(static_cast<int>(A_.rows()));
}

Eigen::VectorXd PriorFactor::difference(double const* const* parameters) const {
  Eigen::VectorXd result(A_.cols());
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    blocks_[i].manifold->Minus(parameters[i], blocks_[i].linearisation.data(), result.data() + at);
    at += blocks_[i].manifold->TangentSize();
  }
  return result;
}

bool PriorFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const StateManifold& manifold = *blocks_[i].manifold;
    const Eigen::Index size = manifold.TangentSize();
    if (jacobians && jacobians[i])
      Eigen::Map<RowMajorMatrix>(jacobians[i], A_.rows(), manifold.AmbientSize()).noalias() =
          A_.middleCols(at, size) * manifold.differenceJacobian(parameters[i], blocks_[i].linearisation.data());
    at += size;
  }
  Eigen::Map<Eigen::VectorXd>(residuals, A_.rows()) = r_0_ + A_ * difference(parameters);
  return true;
}

std::unique_ptr<PriorFactor> makeBlockPrior(std::shared_ptr<const StateManifold> manifold, const Eigen::VectorXd& x_0,
                                            const Eigen::VectorXd& sigma) {
  const Eigen::Index size = manifold->TangentSize();
  std::vector<PriorBlock> blocks{{std::move(manifold), x_0}};
  return std::make_unique<PriorFactor>(std::move(blocks), Eigen::MatrixXd(sigma.cwiseInverse().asDiagonal()),
                                       Eigen::VectorXd::Zero(size));
}

}  // namespace lintel
