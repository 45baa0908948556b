// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "lintel/factors/StateBlocks.h"

namespace lintel {

/// An image observation on the normalised plane and how it moves with the camera correction.
struct NormalisedObservation {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();      ///< (x/z, y/z)
  ObservationJacobian correction_jacobian = ObservationJacobian::Zero();

  /// The observation under a correction, to first order.
  Eigen::Vector2d corrected(const double* correction) const {
    return position + correction_jacobian * Eigen::Map<const CorrectionBlock>(correction);
  }
};

/// Reprojection of a point with inverse depth lambda along its ray in the host camera i, seen by camera j:
///
///   g = R_cj_ci (x_i, 1) + lambda p_cj_ci,    r = weight (g.xy / g.z - x_j)        [Qin2018]
///
/// `weight` = focal / sigma_px: residuals in standard deviations. Blocks: pose_i (T_w_bi), pose_j (T_w_bj),
/// extrinsics (T_b_c), correction, depth. Finite for lambda -> 0.
class PointFactor final
    : public ceres::SizedCostFunction<2, kPoseSize, kPoseSize, kPoseSize, kCorrectionSize, 1> {
 public:
  PointFactor(const NormalisedObservation& host, const NormalisedObservation& target, double weight)
      : host_(host), target_(target), weight_(weight) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  NormalisedObservation host_, target_;
  double weight_;
};

}  // namespace lintel
