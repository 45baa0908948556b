// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace lintel {

// Least squares with four unknowns: a line, or a point in homogeneous coordinates.

/// Normal equations of a sum of squared residuals at one place, in its tangent space.
struct NormalEquations4 {
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();  ///< sum of w J^T J
  Eigen::Vector4d b = Eigen::Vector4d::Zero();  ///< sum of w J^T r
  double cost = 0;

  /// Adds w J^T J and w J^T r of a residual; the cost is the caller's.
  void add(const Eigen::Matrix<double, 2, 4>& J, const Eigen::Vector2d& r, double w = 1);
};

/// How levenbergMarquardt() damps and when it ends.
struct LevenbergParams {
  double damping = 1e-4;        ///< at first, of the diagonal of H; a tenth after a good step, tenfold after a bad one
  double max_damping = 1e6;     ///< a damping above ends it
  double absolute_damping = 0;  ///< added to the diagonal of H
  double trace_damping = 0;     ///< times the trace of H, added to its diagonal
  double min_relative_decrease = 1e-6;  ///< of the cost; a smaller one ends it
  int max_iterations = 15;
};

/// The step -(H + damping)^-1 b.
Eigen::Vector4d dampedStep(const NormalEquations4& normal, double damping, const LevenbergParams& params);

/// Minimises a cost by Levenberg-Marquardt. `linearise(state)` gives the normal equations, with an infinite
/// cost where the state is not allowed; `moved(state, step)` the state after a step in its tangent space. Returns the
/// normal equations at the state it ends in.
template <class State, class Linearise, class Moved>
NormalEquations4 levenbergMarquardt(const LevenbergParams& params, State& state, const Linearise& linearise,
                                    const Moved& moved) {
  NormalEquations4 now = linearise(state);
  double damping = params.damping;
  for (int i = 0; i < params.max_iterations && std::isfinite(now.cost) && damping <= params.max_damping; ++i) {
    const State next_state = moved(state, dampedStep(now, damping, params));
    const NormalEquations4 next = linearise(next_state);
    if (!(next.cost < now.cost)) {
      damping *= 10;
      continue;
    }
    const bool converged = now.cost - next.cost < params.min_relative_decrease * now.cost;
    state = next_state;
    now = next;
    damping *= 0.1;
    if (converged) break;
  }
  return now;
}

/// The inverse of an information matrix. Eigenvalues below 1e-6 count as 1e-6: what is not observed gets a sigma of
/// 1000 instead of an inverse that fails.
Eigen::Matrix4d covarianceOf(const Eigen::Matrix4d& information);

/// The largest standard deviation in any direction.
double worstSigma(const Eigen::Matrix2d& covariance);

}  // namespace lintel
