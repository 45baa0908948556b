// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/factors/ImageFactor.h"

namespace lintel {

/// An image observation on the normalised plane and how it moves with the camera correction.
struct NormalisedObservation {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< (x/z, y/z)
  ObservationJacobian correction_jacobian = ObservationJacobian::Zero();

  /// The observation under a correction, to first order.
  Eigen::Vector2d corrected(const double* correction) const {
    return position + correction_jacobian * Eigen::Map<const CorrectionBlock>(correction);
  }
};

/// Distances of the two observed end points to the projected infinite line, on the normalised plane
/// ([Lim2021] line residual, [Bartoli2005]):
///
///   (n, d) = line block, moment about the constant world point `origin_w`
///   l = n_c = R_c_w (n + (origin_w - p_w_c) x d),    r_k = weight x_k^T l / sqrt(l_1^2 + l_2^2),  k = start, end
///
/// `weight` = focal / sigma_px. Blocks: pose (T_w_b), extrinsics (T_b_c), correction, line. A constant origin near the
/// line keeps phi well conditioned far from the world's origin.
class LineFactor final : public ImageFactor<LineTarget> {
 public:
  LineFactor(const NormalisedObservation& start, const NormalisedObservation& end, const FrameMotion& motion,
             const Eigen::Vector3d& origin_w, double weight)
      : ImageFactor(motion), start_(start), end_(end), origin_w_(origin_w), weight_(weight) {}
  void linearise(const CameraView& view, const double* correction, const double* line, bool jacobians,
                 LineLinearisation& out) const override;

 private:
  NormalisedObservation start_, end_;
  Eigen::Vector3d origin_w_;
  double weight_;
};

}  // namespace lintel
