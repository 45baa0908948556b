// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/factors/ImageFactor.h"

namespace lintel {

constexpr int kCarriageScaleSize = 1;

/// How a pose hangs on two others, a and n, between which it lies in time: its rotation stays as it is seen from a, its
/// position keeps its distance from the point at the share s of the way from a to n, times a scale e that all poses
/// share from one start of the odometry to the next:
///
///   R_w_b = R_w_a R_a_b,   p_w_b = (1 - s) p_w_a + s p_w_n + e R_w_a c.
///
/// So it follows the velocity of the trajectory, and its scale: c is by how much the way bends between a and n, with
/// the scale that the trajectory had, and is no knowledge about that scale.
class Carriage {
 public:
  Carriage(const Pose& T_w_b, const Pose& T_w_a, const Pose& T_w_n, double share);

  Pose pose(const Pose& T_w_a, const Eigen::Vector3d& p_w_n, double scale) const;

  double share() const { return share_; }                        ///< s
  const Eigen::Quaterniond& rotation() const { return R_a_b_; }  ///< R_a_b
  const Eigen::Vector3d& offset() const { return c_a_; }         ///< c, axes of a

 private:
  double share_;
  Eigen::Quaterniond R_a_b_;
  Eigen::Vector3d c_a_;
};

/// A residual of an image whose body pose is carried by two others. Blocks: pose of a, extrinsics, correction, target,
/// pose of n, scale e. With J_p and J_theta with respect to the carried pose the Jacobians are
///
///   a: (1 - s) J_p,  J_theta R_a_b^T - J_p R_w_a [e c]x;   n: s J_p, 0;   e: J_p R_w_a c.
template <class Target>
class CarriedView final : public ceres::SizedCostFunction<Target::kRows, kPoseSize, kPoseSize, kCorrectionSize,
                                                          Target::kSize, kPoseSize, kCarriageScaleSize> {
 public:
  /// `view` and `carriage` must outlive this.
  CarriedView(const ImageFactor<Target>& view, const Carriage& carriage) : view_(view), carriage_(carriage) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const ImageFactor<Target>& view_;
  const Carriage& carriage_;
};

extern template class CarriedView<PointTarget>;
extern template class CarriedView<LineTarget>;

}  // namespace lintel
