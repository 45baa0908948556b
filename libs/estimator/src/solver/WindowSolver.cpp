// SPDX-License-Identifier: BSD-3-Clause
#include "solver/WindowSolver.h"

#include <algorithm>
#include <cmath>

#include "solver/ReducedSystem.h"

namespace lintel {

namespace {

// From Gauss-Newton to next to no step.
constexpr double kLeastDamping = 1e-12, kMostDamping = 1e8;
constexpr double kLeastGain = 1e-3;  // of the decrease that the model promised

}  // namespace

void holdCalibration(ReducedSystem& system, const CalibrationParams& calibration) {
  constexpr BlockKey kCorrection{BlockKey::kCorrection, 0};
  if (!calibration.refine_extrinsics) system.hold({BlockKey::kExtrinsics, 0}, 0, kPoseTangent);
  if (!calibration.refine_camera) system.hold(kCorrection, 0, kReadoutAt);
  if (!calibration.refine_readout) system.hold(kCorrection, kReadoutAt, 1);
  if (!calibration.refine_axes) system.hold({BlockKey::kAxes, 0}, 0, kAxesSize);
  if (!calibration.refine_time_offset) system.hold(kCorrection, kTimeOffsetAt, 1);
}

SolveSummary solveWindow(SlidingWindow& window, const std::vector<Factor>& factors,
                         const CalibrationParams& calibration, const SolveLimits& limits) {
  std::set<BlockKey> frozen;
  if (!calibration.refine_extrinsics) frozen.insert({BlockKey::kExtrinsics, 0});
  if (!calibration.refine_camera && !calibration.refine_readout && !calibration.refine_time_offset)
    frozen.insert({BlockKey::kCorrection, 0});
  if (!calibration.refine_axes) frozen.insert({BlockKey::kAxes, 0});
  ReducedSystem system(window, factors, {}, frozen);
  holdCalibration(system, calibration);

  SolveSummary summary;
  double cost = summary.initial_cost = system.linearise();
  summary.levels = system.levels();
  double damping = limits.first_damping, raise = 2;
  while (summary.iterations < limits.max_iterations && damping < kMostDamping) {
    ++summary.iterations;
    double moved_cost = cost, gain = 0;
    if (system.solve(damping)) {
      if (system.modelDecrease() < 1e-10 * cost) break;
      system.apply();
      moved_cost = system.cost();
      gain = (cost - moved_cost) / system.modelDecrease();
      if (!(gain > kLeastGain)) system.revert();
    }
    if (!(gain > kLeastGain)) {  // [Nielsen1999]
      damping *= raise;
      raise *= 2;
      continue;
    }
    // A step that rejections have damped is short wherever the minimum lies.
    const bool settled = damping <= limits.first_damping && system.statesMove() < limits.min_move;
    const bool converged = settled || cost - moved_cost < limits.tolerance * cost;
    cost = moved_cost;
    if (converged) break;
    damping = std::max(kLeastDamping, damping * std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3)));
    raise = 2;
    if (summary.iterations < limits.max_iterations) system.linearise();
  }
  summary.final_cost = cost;
  if (limits.information) summary.information = system.eliminate();
  return summary;
}

}  // namespace lintel
