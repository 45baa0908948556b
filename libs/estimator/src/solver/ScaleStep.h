// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// The change of scale about a centre that is part of a step of a window's states.
///
/// Images do not change when all positions and landmarks become larger about a centre, and a start knows the scale to
/// ten per cent only. Positions scale linearly, but a landmark's distance is in its block as an inverse (PointFactor.h)
/// or an angle (PluckerLine.h): a step that is linear in these leaves the scaling by the square of the change, which
/// images refuse. Levenberg-Marquardt then goes to the right scale in short steps, sixty instead of seven.
class ScaleStep {
 public:
  ScaleStep(const Eigen::Vector3d& centre_w, double change);

  /// `change` is 0.1 where everything becomes larger by a tenth.
  double change() const { return change_; }

  /// A landmark's `step` from `block` (tangent space of its kind) to `moved`: its part that is the change of scale
  /// scales the landmark, the rest is added as the manifold does. `origin_w`: the landmark's, see SlidingWindow.
  void plus(BlockKey::Kind kind, const Eigen::Vector3d& origin_w, const double* block, const double* step,
            double* moved) const;

 private:
  Eigen::Vector3d centre_w_;
  double change_;
};

/// How far a landmark is from a centre; `origin`: its own, seen from that centre.
double landmarkDistance(BlockKey::Kind kind, const Eigen::Vector3d& origin, const double* block);

/// The constant point that a point or a line is relative to.
const Eigen::Vector3d& originOf(const SlidingWindow& window, const BlockKey& landmark);

}  // namespace lintel
