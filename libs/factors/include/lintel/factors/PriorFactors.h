// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "lintel/factors/Manifolds.h"
#include "lintel/factors/StateBlocks.h"

namespace lintel {

/// What a change of the world's position and yaw, which no measurement sees, does to a block.
enum class GaugeAction {
  kNone,    ///< calibration
  kPose,    ///< p <- R p + t, R_w_b <- R R_w_b
  kMotion,  ///< v <- R v
  kPoint,   ///< X + w o <- R (X + w o) + w t, with o the point's origin
};

/// One block of a prior: what it was when the prior was made.
struct PriorBlock {
  std::shared_ptr<const StateManifold> manifold;
  Eigen::VectorXd linearisation;  ///< ambient
  GaugeAction action = GaugeAction::kNone;
  Eigen::Vector3d origin_w = Eigen::Vector3d::Zero();  ///< of a point: what X / w is relative to
};

/// x' ⊟ x_0 of all blocks of a prior, and its derivatives with respect to their tangents:
/// d value = blockdiag(by_block) dx + by_alignment alignment_by_anchor dx_anchor.
struct PriorDifference {
  Eigen::VectorXd value;
  std::vector<Eigen::MatrixXd> by_block;  ///< an empty one is the identity
  Eigen::Matrix<double, Eigen::Dynamic, 4> by_alignment;
  Eigen::Matrix<double, 4, kPoseTangent> alignment_by_anchor;
};

/// r = A (x' ⊟ x_0) + r_0 over any blocks: what marginalisation leaves, or plain knowledge about a state.
///
/// A prior over poses says nothing about the world's position and yaw, but linearised it says so at x_0 only: elsewhere
/// A (x ⊟ x_0) changes when the world turns, and the estimate gains information about its yaw that nobody measured
/// [Huang2009]. Therefore x' is x moved by the shift and the turn about the vertical that bring the first block with
/// GaugeAction::kPose, the anchor, back to where x_0 has it: r does not change at all when the world moves. Without an
/// anchor x' = x. Jacobians are exact also away from x_0.
class PriorFactor final : public ceres::CostFunction {
 public:
  /// `A`: rows x sum of tangent sizes in the order of `blocks`; `r_0`: rows.
  PriorFactor(std::vector<PriorBlock> blocks, Eigen::MatrixXd A, Eigen::VectorXd r_0);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  const std::vector<PriorBlock>& blocks() const { return blocks_; }
  const Eigen::VectorXd& constant() const { return r_0_; }             ///< r_0
  const Eigen::MatrixXd& root() const { return A_; }                   ///< A
  const Eigen::MatrixXd& information() const { return information_; }  ///< A' A
  int anchor() const { return anchor_; }                               ///< place among the blocks; negative: none

  PriorDifference difference(double const* const* parameters, bool derivatives) const;

 private:
  std::vector<PriorBlock> blocks_;
  Eigen::MatrixXd A_;
  Eigen::VectorXd r_0_;
  Eigen::MatrixXd information_;
  int anchor_ = -1;
};

/// Independent knowledge about one block: r_k = (x ⊟ x_0)_k / sigma_k; a sigma of infinity leaves a component free.
std::unique_ptr<PriorFactor> makeBlockPrior(std::shared_ptr<const StateManifold> manifold, const Eigen::VectorXd& x_0,
                                            const Eigen::VectorXd& sigma);

}  // namespace lintel
