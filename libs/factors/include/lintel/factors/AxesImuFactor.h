// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/factors/ImuFactor.h"

namespace lintel {

/// An ImuFactor whose sensors have axes that are wrong by A and G (ImuAxes.h): the deltas change by what these add to
/// the samples, to first order. Blocks: those of ImuFactor, then the axes.
class AxesImuFactor final
    : public ceres::SizedCostFunction<15, kPoseSize, kMotionSize, kPoseSize, kMotionSize, kMeanBiasSize, kAxesSize> {
 public:
  /// `mean_f`: ImuAxes::mean_f.
  AxesImuFactor(std::shared_ptr<const Preintegration> preintegration, const Eigen::Vector3d& mean_f);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  ImuFactor factor_;
  Eigen::Matrix<double, 9, kAxesSize> by_axes_;  ///< d residuals / d (A, G)
};

}  // namespace lintel
