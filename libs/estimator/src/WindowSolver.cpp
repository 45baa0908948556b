// SPDX-License-Identifier: BSD-3-Clause
#include "WindowSolver.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <map>
#include <vector>

namespace lintel {

namespace {

bool isLandmark(BlockKey::Kind kind) { return kind == BlockKey::kPoint || kind == BlockKey::kLine; }

/// A Ceres problem over copies of the window's blocks. Ceres orders blocks by their addresses: the copies lie in one
/// array in the order of their keys, so that the same sums are made in the same order every run.
class ProblemBuilder {
 public:
  ProblemBuilder(SlidingWindow& window, const std::vector<Factor>& factors) : window_(window), problem_(options()) {
    placeBlocks(factors);
    std::vector<double*> blocks;
    for (const Factor& factor : factors) {
      blocks.clear();
      for (const BlockKey& key : factor.blocks) blocks.push_back(pointerOf(key));
      problem_.AddResidualBlock(const_cast<ceres::CostFunction*>(factor.cost),
                                const_cast<ceres::LossFunction*>(factor.loss), blocks);
    }
  }

  void freeze(const BlockKey& key) {
    if (offsets_.count(key) > 0) problem_.SetParameterBlockConstant(pointerOf(key));
  }

  void copyBack() {
    for (const auto& [key, offset] : offsets_)
      std::copy_n(values_.data() + offset, manifoldOf(key.kind)->AmbientSize(), window_.block(key));
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

  double* pointerOf(const BlockKey& key) { return values_.data() + offsets_.at(key); }

  void placeBlocks(const std::vector<Factor>& factors) {
    for (const Factor& factor : factors)
      for (const BlockKey& key : factor.blocks) offsets_.emplace(key, 0);
    std::size_t size = 0;
    for (auto& [key, offset] : offsets_) {
      offset = size;
      size += static_cast<std::size_t>(manifoldOf(key.kind)->AmbientSize());
    }
    values_.resize(size);
    for (const auto& [key, offset] : offsets_) {
      auto* manifold = const_cast<StateManifold*>(manifoldOf(key.kind).get());
      std::copy_n(window_.block(key), manifold->AmbientSize(), values_.data() + offset);
      const bool curved = manifold->AmbientSize() != manifold->TangentSize();
      problem_.AddParameterBlock(values_.data() + offset, manifold->AmbientSize(), curved ? manifold : nullptr);
      ordering_->AddElementToGroup(values_.data() + offset, isLandmark(key.kind) ? 0 : 1);
    }
  }

  SlidingWindow& window_;
  ceres::Problem problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_ = std::make_shared<ceres::ParameterBlockOrdering>();
  std::map<BlockKey, std::size_t> offsets_;
  std::vector<double> values_;
};

}  // namespace

SolveSummary solveWindow(SlidingWindow& window, const std::vector<Factor>& factors, const CalibrationParams& calibration,
                         int max_iterations) {
  ProblemBuilder builder(window, factors);
  if (!calibration.refine_extrinsics) builder.freeze({BlockKey::kExtrinsics, 0});
  if (!calibration.refine_camera && !calibration.refine_time_offset) builder.freeze({BlockKey::kCorrection, 0});

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = builder.ordering();
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-3;  // the next frame goes on from here; 1e-4 costs a tenth more and changes nothing
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &builder.problem(), &summary);
  builder.copyBack();
  for (WindowFrame& frame : window.frames) frame.pose.tail<4>().normalize();
  return {static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost,
          summary.IsSolutionUsable()};
}

}  // namespace lintel
