// SPDX-License-Identifier: BSD-3-Clause
#include "WindowSolver.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <map>

namespace lintel {

namespace {

bool isLandmark(BlockKey::Kind kind) { return kind == BlockKey::kPoint || kind == BlockKey::kLine; }

class ProblemBuilder {
 public:
  explicit ProblemBuilder(SlidingWindow& window) : window_(window), problem_(options()) {
    ordering_ = std::make_shared<ceres::ParameterBlockOrdering>();
  }

  void add(const Factor& factor) {
    blocks_.clear();
    for (const BlockKey& key : factor.blocks) blocks_.push_back(pointerOf(key));
    problem_.AddResidualBlock(const_cast<ceres::CostFunction*>(factor.cost),
                              const_cast<ceres::LossFunction*>(factor.loss), blocks_);
  }

  void freeze(const BlockKey& key) {
    if (auto it = pointers_.find(key); it != pointers_.end()) problem_.SetParameterBlockConstant(it->second);
  }

  ceres::Problem& problem() { return problem_; }
  const std::shared_ptr<ceres::ParameterBlockOrdering>& ordering() const { return ordering_; }

 private:
  static ceres::Problem::Options options() {
    ceres::Problem::Options o;
    o.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    o.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    o.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    o.disable_all_safety_checks = true;
    return o;
  }

  double* pointerOf(const BlockKey& key) {
    auto [it, fresh] = pointers_.try_emplace(key, nullptr);
    if (!fresh) return it->second;
    it->second = window_.block(key);
    auto* manifold = const_cast<StateManifold*>(manifoldOf(key.kind).get());
    const bool curved = manifold->AmbientSize() != manifold->TangentSize();
    problem_.AddParameterBlock(it->second, manifold->AmbientSize(), curved ? manifold : nullptr);
    ordering_->AddElementToGroup(it->second, isLandmark(key.kind) ? 0 : 1);
    return it->second;
  }

  SlidingWindow& window_;
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
  std::map<BlockKey, double*> pointers_;
  std::vector<double*> blocks_;
};

}  // namespace

SolveSummary solveWindow(SlidingWindow& window, const std::vector<Factor>& factors, const CalibrationParams& calibration,
                         int max_iterations) {
  ProblemBuilder builder(window);
  for (const Factor& factor : factors) builder.add(factor);
  if (!calibration.refine_extrinsics) builder.freeze({BlockKey::kExtrinsics, 0});
  if (!calibration.refine_camera && !calibration.refine_time_offset) builder.freeze({BlockKey::kCorrection, 0});

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = builder.ordering();
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-4;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &builder.problem(), &summary);

  for (WindowFrame& frame : window.frames) frame.pose.tail<4>().normalize();
  return {static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost,
          summary.IsSolutionUsable()};
}

}  // namespace lintel
