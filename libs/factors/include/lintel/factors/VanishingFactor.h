// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "lintel/factors/CameraView.h"
#include "lintel/factors/LineFactor.h"

namespace lintel {

/// A vanishing residual at some states.
struct VanishingLinearisation {
  double residual = 0;
  Eigen::Matrix<double, 1, kCameraTangent> d_camera;
  Eigen::Matrix<double, 1, kIntrinsicsSize> d_intrinsics;
  Eigen::Matrix<double, 1, kDirectionSize> d_direction;  ///< ambient
};

/// An image line whose direction in space is shared but whose distance nobody knows: its observation plane contains the
/// direction, that is, the image line passes the vanishing point:
///
///   r = weight (x_start x x_end) / |x_start x x_end| . R_c_w d
///
/// It knows rotations only: no distance is guessed that would claim to know translations. `weight` = 1 / sigma of the
/// angle between plane and direction. Blocks: pose (T_w_b), extrinsics (T_b_c), correction, direction.
class VanishingFactor final
    : public ceres::SizedCostFunction<1, kPoseSize, kPoseSize, kCorrectionSize, kDirectionSize> {
 public:
  VanishingFactor(const NormalisedObservation& start, const NormalisedObservation& end, const FrameMotion& motion,
                  double weight)
      : start_(start), end_(end), motion_(motion), weight_(weight) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  /// The residual seen from a camera that is known already; Jacobians only when asked for.
  void linearise(const CameraView& view, const double* correction, const double* direction, bool jacobians,
                 VanishingLinearisation& out) const;
  const FrameMotion& motion() const { return motion_; }

 private:
  NormalisedObservation start_, end_;
  FrameMotion motion_;
  double weight_;
};

}  // namespace lintel
