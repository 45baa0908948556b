// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "lintel/factors/ImuFactor.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/PointFactor.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/factors/VanishingFactor.h"

namespace lintel {

/// A residual of the window: its cost, its loss (null: none) and the blocks it depends on.
struct Factor {
  const ceres::CostFunction* cost = nullptr;
  const ceres::LossFunction* loss = nullptr;
  std::vector<BlockKey> blocks;
};

/// The manifold of a kind of block; shared, stateless.
const std::shared_ptr<const StateManifold>& manifoldOf(BlockKey::Kind kind);

/// Makes the residuals of a window and owns them. Solver and marginaliser ask for what they need: the same residual is
/// built in one place only.
class WindowFactors {
 public:
  WindowFactors(const SlidingWindow& window, const FactorParams& params);

  void addPriors();
  void addCalibrationPriors(const CalibrationParams& params, const Pose& T_b_c_calibrated);
  /// Ties position and yaw of the oldest frame to what they are: the four directions that no measurement sees. Without
  /// it a solve may turn the whole window, and the causal trajectory would jump. Never marginalised.
  void addGauge();
  void addImu();
  void addRest(double velocity_sigma);
  void addPoints();
  void addLines(const DegeneracyParams& degeneracy);

  /// Only these: residuals between the first frame and others, for marginalising it.
  void addImuAfter(FrameId frame);
  void addRestOf(const WindowFrame& frame, double velocity_sigma);  ///< nothing unless it is at rest
  void addPoint(const PointTrack& track);
  void addLine(const LineTrack& track,
               const DegeneracyParams& degeneracy);  ///< and what ties it to its group, if it has one
  void addSightings(const LineTrack& track);         ///< without what ties it
  void addVanishing(const LineTrack& track, const LineSighting& sighting, const DegeneracyParams& degeneracy);
  void add(std::unique_ptr<ceres::CostFunction> cost, std::vector<BlockKey> blocks);

  const std::vector<Factor>& factors() const { return factors_; }

 private:
  void setStructuralLoss(const DegeneracyParams& degeneracy);
  void addImu(const WindowFrame& before, const WindowFrame& frame);

  const FrameMotion& motionOf(FrameId id) const { return motions_.at(id); }

  const SlidingWindow& window_;
  const FactorParams& params_;
  ceres::CauchyLoss point_loss_, line_loss_;
  std::unique_ptr<ceres::LossFunction> structural_loss_;
  std::map<FrameId, FrameMotion> motions_;
  std::vector<Factor> factors_;
  std::deque<PointFactor> point_factors_;
  std::deque<LineFactor> line_factors_;
  std::vector<std::unique_ptr<ceres::CostFunction>> others_;
};

}  // namespace lintel
