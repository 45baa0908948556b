// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/AxesImuFactor.h"

namespace lintel {

AxesImuFactor::AxesImuFactor(std::shared_ptr<const Preintegration> preintegration, const Eigen::Vector3d& mean_f)
    : factor_(std::move(preintegration)) {
  by_axes_ = -factor_.sqrtInformation() * factor_.preintegration().axesJacobian(mean_f);
}

bool AxesImuFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  if (!factor_.Evaluate(parameters, residuals, jacobians)) return false;
  Eigen::Map<Eigen::Matrix<double, 9, 1>>(residuals) += by_axes_ * Eigen::Map<const AxesBlock>(parameters[5]);
  if (jacobians && jacobians[5]) {
    Eigen::Map<Eigen::Matrix<double, 15, kAxesSize, Eigen::RowMajor>> out(jacobians[5]);
    out.topRows<9>() = by_axes_;
    out.bottomRows<6>().setZero();
  }
  return true;
}

}  // namespace lintel
