// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <memory>

#include "lintel/factors/StateBlocks.h"

namespace lintel {

/// Pre-integrated IMU between two states [Forster2017, eq. 45], 15 residuals in units of their standard deviation:
///
///   r_theta = Log(delta_R(b_i)^-1 R_i^-1 R_j)
///   r_v     = R_i^-1 (v_j - v_i - g dt) - delta_v(b_i)
///   r_p     = R_i^-1 (p_j - p_i - v_i dt - g dt^2 / 2) - delta_p(b_i)
///   r_bg    = bias_gyro_j - bias_gyro_i                                                  (a random walk)
///   r_ba    = bias_accel_j - m - a (bias_accel_i - m),   a = exp(-dt / kAccelCorrelation_s)
///
/// The accelerometer's bias is the sum of a random walk m, here constant, and of correlated noise (ImuNoise); a = 1
/// without such noise.
///
/// Blocks: pose_i, motion_i, pose_j, motion_j, m. The pre-integration must outlive the factor and not change meanwhile.
class ImuFactor final
    : public ceres::SizedCostFunction<15, kPoseSize, kMotionSize, kPoseSize, kMotionSize, kMeanBiasSize> {
 public:
  explicit ImuFactor(std::shared_ptr<const Preintegration> preintegration);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  const Preintegration& preintegration() const { return *preintegration_; }

  /// W of the residuals W (r_theta, r_v, r_p).
  const Eigen::Matrix<double, 9, 9>& sqrtInformation() const { return sqrt_information_; }

 private:
  std::shared_ptr<const Preintegration> preintegration_;
  Eigen::Matrix<double, 9, 9> sqrt_information_;
  double gyro_walk_weight_ = 0, accel_walk_weight_ = 0;
  double kept_ = 1;  ///< a
};

}  // namespace lintel
