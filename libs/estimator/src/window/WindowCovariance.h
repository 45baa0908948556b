// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "lintel/estimator/SlidingWindow.h"
#include "lintel/inertial/Propagation.h"
#include "solver/Marginals.h"

namespace lintel {

/// Covariances of the causal trajectory's states, relative to its first pose. Position and yaw of the window's oldest
/// frame i are held, so an error has two parts:
///
///   e = dx + N c        c: WorldDrift, N: what a shift and a turn of the world do to the state
///
/// dx with the oldest frame held has the covariance of the window's information H. c was fixed when frame i became the
/// oldest: later measurements change dx, but the trajectory does not go back to move frame i. Its regression on the
/// states, c = K dx + w, holds all the same when they change, since w is independent of what is measured later:
///
///   cov(e, e) = [I N] [S, S K'; K S, V] [I N]'        S = F H^-1 F'
///
/// with V = cov(c, c). When the oldest frame leaves, c gains the error of the next one's position and yaw relative to
/// it, and V with it; K is then taken over the states that stay by the elimination that makes the prior
/// (Marginalizer.cpp). To first order nothing is neglected but what the window itself forgets: residuals of tracks that
/// were dropped, and what the robust losses take for outliers.
///
/// All functions of dx that are used here (F) vanish when the world moves as a whole, so that the stiff residual that
/// holds the oldest frame in H (WindowFactors::addGauge) does not count.
class WindowCovariance {
 public:
  /// `information` of the window's last solve, without damping. The window's estimate may have moved a little since.
  explicit WindowCovariance(NormalEquations information);

  /// False when the information is not positive: then the functions below take the window as known exactly.
  bool ok() const { return marginals_.ok(); }

  /// Position and yaw of this frame are those of the first pose: what later errors are relative to. Gives its
  /// covariance, in which they have none, exactly.
  StateCovariance start(SlidingWindow& window, FrameId first) const;

  /// Of pose and motion of a frame.
  StateCovariance of(const SlidingWindow& window, const WindowFrame& frame) const;

  /// Standard deviation of the distance from the oldest frame to the one farthest from it, relative to that distance:
  /// how well the window knows the scale of what it sees. Infinite while nothing has moved.
  double relativeScaleSigma(const SlidingWindow& window) const;

  /// To be called before the oldest frame is marginalised: the next one is held from then on.
  void holdNext(SlidingWindow& window) const;

  /// To be called before a frame that is no keyframe leaves: the drift hangs on the other states instead.
  void forget(SlidingWindow& window, FrameId leaving) const;

 private:
  /// Sum over blocks of rows of a linear function; blocks that the equations do not have are known exactly.
  void place(const BlockKey& key, const Eigen::MatrixXd& rows, Eigen::MatrixXd& F_transposed) const;

  Eigen::MatrixXd halves(const Eigen::MatrixXd& F_transposed) const;

  /// L^-1 F' of the drift, with the oldest frame held.
  const Eigen::MatrixXd& halvesOfDrift(const SlidingWindow& window) const;

  /// Covariance of w, the part of the drift that the window's states say nothing about. Where information is lost
  /// (images that go dark) these become less certain than the drift was: then it is zero along such a direction.
  Eigen::Matrix4d independentDrift(const SlidingWindow& window) const;

  NormalEquations information_;
  Marginals marginals_;
  mutable std::optional<FrameId> drift_of_;  // the oldest frame that halves_of_drift_ belongs to
  mutable Eigen::MatrixXd halves_of_drift_;
};

}  // namespace lintel
