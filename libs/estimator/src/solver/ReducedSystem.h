// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <set>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"
#include "solver/CameraChain.h"
#include "solver/Factor.h"
#include "solver/LandmarkSystem.h"

namespace lintel {

/// The order of states in normal equations: motions, then poses, each the newest first, then the others. A motion hangs
/// on poses and motions of its neighbours only, and the oldest one on the prior, so few entries come first
/// [SparseCholesky.h].
bool comesBefore(const BlockKey& a, const BlockKey& b);

/// Normal equations in the tangent spaces of some blocks: H dx = -b.
struct NormalEquations {
  std::vector<BlockKey> blocks;       ///< in the order of H
  std::vector<Eigen::Index> offsets;  ///< of the blocks in H; one more entry for the end
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

/// The normal equations of a window's residuals with points and lines eliminated (Schur complement [Triggs2000]), but
/// for those that stay among the states (LandmarkSystem says which).
///
/// The residuals of an image share its camera. They are summed in the tangent spaces of the cameras (six numbers each,
/// plus the correction and the targets that stay), landmarks are eliminated there, and one chain rule for each camera
/// carries the sum over to poses, extrinsics and time offset. Robust losses count as weights.
class ReducedSystem {
 public:
  /// States in `first` come first; those in `frozen` are constants. Factors and window must outlive the system.
  ReducedSystem(SlidingWindow& window, const std::vector<Factor>& factors, const std::set<BlockKey>& first,
                const std::set<BlockKey>& frozen, const std::set<BlockKey>& staying = {});

  /// These components of a block are constants, too: equations without them.
  void hold(const BlockKey& key, int first, int count);

  /// Half the sum of (robust) squares at the window's present values, after a linearisation.
  double cost() const;

  /// Takes residuals and Jacobians at the present values; returns their cost.
  double linearise();

  /// Of the landmarks' residuals at the first linearisation.
  ResidualLevels levels() const { return landmarks_.levels(); }

  /// The states' equations with landmarks eliminated as they are; directions without information stay out.
  NormalEquations eliminate();

  /// Solves with `damping` times the diagonal added [Levenberg]. False when the system is not positive definite.
  bool solve(double damping);

  /// By how much the linear model says that the cost falls with the last solution.
  double modelDecrease() const { return model_decrease_; }

  /// How far the last solution moves the states (all blocks but eliminated landmarks), in their standard deviations:
  /// Mahalanobis distance in the damped system, so that a move by m shifts no combination of states by more than m
  /// sigma.
  double statesMove() const { return states_move_; }

  /// Moves the window's blocks by the last solution; takes that back.
  void apply();
  void revert();

 private:
  void placeStates(const std::set<BlockKey>& first, const std::set<BlockKey>& frozen);
  Eigen::Index offsetOf(const BlockKey& key) const;  ///< negative when frozen or absent
  std::vector<CameraView> views(bool derivatives) const;
  double addOther(const Factor& factor);
  double addPrior(const Factor& factor, const PriorFactor& prior);

  CameraChain chain() const;
  ScaleStep scaleStep() const;  ///< of the last solution
  void leaveOutHeld(Eigen::MatrixXd& H, Eigen::VectorXd& b) const;

  /// Where the columns of a factor's blocks lie, among their own and among the states' (negative: a constant).
  struct Placement {
    std::vector<Eigen::Index> from{0}, to;  ///< `from` with one more entry for the end
    Eigen::Index size() const { return from.back(); }
  };
  Placement placementOf(const Factor& factor) const;
  void addInformation(const Placement& place, const Eigen::MatrixXd& H, const Eigen::VectorXd& b);

  /// Of a factor that is no image's; kept, as memory takes longer to get than most factors to evaluate.
  struct OtherScratch {
    std::vector<const double*> blocks;
    std::vector<double*> ambient;  ///< Jacobians by the blocks' numbers, in `numbers`
    std::vector<double> numbers;
    Eigen::VectorXd r;
    Eigen::MatrixXd J, H;
  };

  SlidingWindow& window_;
  LandmarkSystem landmarks_;
  NormalEquations states_;          // of the others alone, lower triangle
  std::vector<Eigen::Index> held_;  // rows of the states' equations
  std::vector<CameraView> views_;   // at the last linearisation
  Eigen::MatrixXd factor_;          // of the last solution
  Eigen::VectorXd step_;
  std::vector<double> saved_;
  OtherScratch other_;
  double model_decrease_ = 0, states_move_ = 0;
};

}  // namespace lintel
