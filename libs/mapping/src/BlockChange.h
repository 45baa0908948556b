// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

namespace lintel {

/// By how much two blocks of N numbers differ, each number times its weight: 1 over the standard deviation, 0 where it
/// does not count.
template <int N>
class BlockChange final : public ceres::SizedCostFunction<N, N, N> {
 public:
  using Block = Eigen::Matrix<double, N, 1>;

  explicit BlockChange(const Block& weights) : weights_(weights) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Block> before(parameters[0]), after(parameters[1]);
    Eigen::Map<Block>{residuals} = weights_.cwiseProduct(after - before);
    for (int i = 0; i < 2; ++i)
      if (jacobians && jacobians[i])
        Eigen::Map<Eigen::Matrix<double, N, N, Eigen::RowMajor>>{jacobians[i]} =
            ((i == 0 ? -1 : 1) * weights_).asDiagonal();
    return true;
  }

 private:
  Block weights_;
};

}  // namespace lintel
