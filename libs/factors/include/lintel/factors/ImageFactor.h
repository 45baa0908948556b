// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "lintel/factors/CameraView.h"
#include "lintel/factors/FrameMotion.h"
#include "lintel/factors/StateBlocks.h"

namespace lintel {

/// A line as residuals use it, worked out once for all that see it: U and phi of its block, the moment about its origin
/// and the direction.
struct LineAxes {
  Eigen::Matrix3d U;
  double cosine, sine;  ///< of phi
  Eigen::Vector3d n_w, d_w;

  explicit LineAxes(const double* block);
};

// What an image may see: rows of its residuals, sizes of its block, with respect to what `d_target` is, and what
// residuals are given of the block.
struct PointTarget {
  using Value = const double*;
  static constexpr int kRows = 2, kSize = kPointSize, kTangent = kPointTangent;
  static constexpr int kColumns = kPointSize;  ///< ambient
};
struct LineTarget {
  using Value = LineAxes;
  static constexpr int kRows = 2, kSize = kLineSize, kTangent = kLineTangent;
  static constexpr int kColumns = kLineTangent;  ///< tangent
};
struct DirectionTarget {
  using Value = const double*;
  static constexpr int kRows = 1, kSize = kDirectionSize, kTangent = kDirectionTangent;
  static constexpr int kColumns = kDirectionSize;  ///< ambient
};

/// A residual of an image at some states, with its derivatives with respect to the camera's pose (its tangent, see
/// CameraView), to intrinsics and readout, and to the target.
template <class Target>
struct ImageLinearisation {
  static constexpr int R = Target::kRows;
  Eigen::Matrix<double, R, 1> residual;
  Eigen::Matrix<double, R, kCameraTangent> d_camera;
  Eigen::Matrix<double, R, kSightingCorrection> d_correction;
  Eigen::Matrix<double, R, Target::kColumns> d_target;
};

/// A residual of an image that sees a point, a line, or a direction: the interface by which the window's solver
/// linearises it. All residuals of an image have its camera in common, which the solver works out once; a residual adds
/// `linearise`, and Evaluate for Ceres follows from it. Blocks: pose (T_w_b), extrinsics (T_b_c), correction, target.
template <class Target>
class ImageFactor
    : public ceres::SizedCostFunction<Target::kRows, kPoseSize, kPoseSize, kCorrectionSize, Target::kSize> {
 public:
  /// The residual seen from a camera that is known already; Jacobians only when asked for. `target`: of its block.
  virtual void linearise(const CameraView& view, const double* correction, const typename Target::Value& target,
                         bool jacobians, ImageLinearisation<Target>& out) const = 0;

  /// Of the body at the time of the image.
  const FrameMotion& motion() const { return motion_; }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 protected:
  explicit ImageFactor(const FrameMotion& motion) : motion_(motion) {}

 private:
  FrameMotion motion_;
};

using PointLinearisation = ImageLinearisation<PointTarget>;
using LineLinearisation = ImageLinearisation<LineTarget>;
using DirectionLinearisation = ImageLinearisation<DirectionTarget>;

extern template class ImageFactor<PointTarget>;
extern template class ImageFactor<LineTarget>;
extern template class ImageFactor<DirectionTarget>;

}  // namespace lintel
