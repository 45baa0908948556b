// SPDX-License-Identifier: BSD-3-Clause
#include "SolverEnd.h"

#include <cmath>
#include <limits>
#include <utility>

namespace lintel {

namespace {

constexpr double kLeastRescaling = 1e-3;

}  // namespace

SolverEnd::SolverEnd(double least_gain, std::function<Eigen::Matrix3Xd()> way_w, std::function<bool(int)> goOn)
    : least_gain_(least_gain), way_w_(std::move(way_w)), goOn_(std::move(goOn)) {}

/// By what share the scale has changed since the call before; infinite at first, zero without a way.
double SolverEnd::rescaling() {
  const Eigen::Matrix3Xd before_w = std::exchange(last_way_w_, way_w_());
  if (before_w.cols() != last_way_w_.cols()) return std::numeric_limits<double>::infinity();
  const double square = before_w.squaredNorm();
  return square > 0 ? std::abs(last_way_w_.cwiseProduct(before_w).sum() / square - 1) : 0;
}

ceres::CallbackReturnType SolverEnd::operator()(const ceres::IterationSummary& summary) {
  const bool is_small = rescaling() < kLeastRescaling && summary.cost_change >= 0 && summary.cost_change < least_gain_;
  const bool ends = summary.iteration > 0 && summary.step_is_successful && is_small;
  return goOn_(summary.iteration) && !ends ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
}

}  // namespace lintel
