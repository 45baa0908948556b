// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/factors/ImuFactor.h"

namespace lintel {

/// An ImuFactor whose accelerometer has axes that are wrong by A (AccelerometerAxes.h): delta_v and delta_p change by
/// what A adds to the samples. Blocks: those of ImuFactor, then the axes.
class AxesImuFactor final
    : public ceres::SizedCostFunction<15, kPoseSize, kMotionSize, kPoseSize, kMotionSize, kMeanBiasSize, kAxesSize> {
 public:
  /// `mean_f`: AccelerometerAxes::mean_f.
  AxesImuFactor(std::shared_ptr<const Preintegration> preintegration, const Eigen::Vector3d& mean_f);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  ImuFactor factor_;
  Eigen::Matrix<double, 9, kAxesSize> by_axes_;  ///< d residuals / d A
};

}  // namespace lintel
