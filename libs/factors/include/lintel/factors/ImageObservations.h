// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <utility>

#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/Camera.h"

namespace lintel {

/// The ray of an image observation (Camera.h) and how it moves with the camera correction, about one correction.
struct RayObservation {
  using Row = Eigen::Matrix<double, 1, kIntrinsicsSize>;
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
  ObservationJacobian correction_jacobian = ObservationJacobian::Zero();  ///< of x and y of the ray
  Row z_jacobian = Row::Zero();                                           ///< of z: of wide lenses only
  IntrinsicsBlock linearised_at = IntrinsicsBlock::Zero();
  bool wide = false;

  /// The ray under a correction, to first order.
  Eigen::Vector3d corrected(const double* correction) const;

  /// d (v . ray) / d intrinsics.
  Row alongJacobian(const Eigen::Vector3d& v) const;
};

/// An observed end point of a line, and how many pixels a distance of 1 across the line is there. That scale moves with
/// the camera correction, too: with a constant one, distances of rays would be the smaller the longer the focal length,
/// and every line would pull at it.
struct LineEnd : RayObservation {
  double linearised_scale_px = 1;        ///< at `linearised_at`
  Row log_scale_jacobian = Row::Zero();  ///< d log scale / d intrinsics

  /// Under a correction, to first order [px].
  double scale_px(const double* correction) const;
};

/// How an observed pixel depends on the camera correction (intrinsics, by the camera model), about `correction`.
RayObservation makeObservation(const Camera& calibrated, const Eigen::Vector2d& px,
                               const CorrectionBlock& correction = CorrectionBlock::Zero());

/// The two end points of an observed line [px], a straight line of the calibrated camera that was fitted to an edge; of
/// the corrected one those of the line that fits the same edge best. Their scales are across the line through both.
std::pair<LineEnd, LineEnd> makeLineEnds(const Camera& calibrated, const Eigen::Vector2d& start_px,
                                         const Eigen::Vector2d& end_px,
                                         const CorrectionBlock& correction = CorrectionBlock::Zero());

}  // namespace lintel
