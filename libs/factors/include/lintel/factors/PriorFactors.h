// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "lintel/factors/Manifolds.h"

namespace lintel {

/// One block of a prior: what it was when the prior was made.
struct PriorBlock {
  std::shared_ptr<const StateManifold> manifold;
  Eigen::VectorXd linearisation;  ///< ambient
};

/// r = A (x ⊟ x_0) + r_0 over any blocks: what marginalisation leaves, or plain knowledge about a state.
/// The Jacobian is exact also away from x_0.
class PriorFactor final : public ceres::CostFunction {
 public:
  /// `A`: rows x sum of tangent sizes in the order of `blocks`; `r_0`: rows.
  PriorFactor(std::vector<PriorBlock> blocks, Eigen::MatrixXd A, Eigen::VectorXd r_0);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  const std::vector<PriorBlock>& blocks() const { return blocks_; }
  const Eigen::VectorXd& constant() const { return r_0_; }             ///< r_0
  const Eigen::MatrixXd& root() const { return A_; }                   ///< A
  const Eigen::MatrixXd& information() const { return information_; }  ///< A' A

  /// x ⊟ x_0 of all blocks.
  Eigen::VectorXd difference(double const* const* parameters) const;

 private:
  std::vector<PriorBlock> blocks_;
  Eigen::MatrixXd A_;
  Eigen::VectorXd r_0_;
  Eigen::MatrixXd information_;
};

/// Independent knowledge about one block: r_k = (x ⊟ x_0)_k / sigma_k; a sigma of infinity leaves a component free.
std::unique_ptr<PriorFactor> makeBlockPrior(std::shared_ptr<const StateManifold> manifold, const Eigen::VectorXd& x_0,
                                            const Eigen::VectorXd& sigma);

}  // namespace lintel
