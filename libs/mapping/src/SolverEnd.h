// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/iteration_callback.h>

#include <Eigen/Core>
#include <functional>

namespace lintel {

/// Decides after each iteration of an adjustment whether to go on. It ends when a successful iteration lowers the cost
/// by less than `least_gain` and changes the scale of the way by less than a thousandth. Where motion is gentle the
/// scale is one direction among hundreds, along which the cost is flat: it still goes on by per cents when the gain,
/// which all poses share, is small.
class SolverEnd final : public ceres::IterationCallback {
 public:
  /// `way_w`: the way from pose to pose as it is now, 3 x n [m]. `goOn`: called with the number of the iteration;
  /// false ends. Ceres has to update its state every iteration.
  SolverEnd(double least_gain, std::function<Eigen::Matrix3Xd()> way_w, std::function<bool(int)> goOn);

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override;

 private:
  double rescaling();

  double least_gain_;
  std::function<Eigen::Matrix3Xd()> way_w_;
  std::function<bool(int)> goOn_;
  Eigen::Matrix3Xd last_way_w_;  ///< after the iteration before
};

}  // namespace lintel
