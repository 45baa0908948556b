// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <memory_resource>
#include <vector>

#include "landmarks/CameraPoses.h"
#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/PointFactor.h"
#include "solver/Factor.h"

namespace lintel {

/// The tracks whose sightings are wanted; by default all.
struct TrackChoice {
  std::function<bool(const PointTrack&)> point = [](const PointTrack&) { return true; };
  std::function<bool(const LineTrack&)> line = [](const LineTrack&) { return true; };
};

/// Makes the residuals of a window and owns them: in one place for solver, marginaliser and covariances.
class WindowFactors {
 public:
  WindowFactors(const SlidingWindow& window, const FactorParams& params);
  WindowFactors(const SlidingWindow& window, FactorParams&& params) = delete;  // keeps a reference

  /// All that is known: priors, gauge, calibration, measurements.
  void addAll(const EstimatorParams& params, const Pose& T_b_c_calibrated);

  /// What was measured: IMU, rest, points, lines. These go into a prior when a frame leaves that they touch; a new kind
  /// of residual is added here.
  void addMeasurements(const EstimatorParams& params, const TrackChoice& choice = {});

  void addPriors();
  /// Of what is refined; the solver holds the rest (holdCalibration). They have a robust loss, the lever arm's once the
  /// scale is known: before, as at a take-off, one that leaves its prior explains as much as another scale does.
  void addCalibrationPriors(const CalibrationParams& params, const Pose& T_b_c_calibrated);
  /// Ties position and yaw of the oldest frame to what they are: the four directions that no measurement sees. Without
  /// it a solve may turn the whole window, and the causal trajectory would jump. Never marginalised.
  void addGauge();
  void addAxesPrior(const CalibrationParams& params);
  void addImu();
  void addRest(const EstimatorParams& params);
  void addPoints(const TrackChoice& choice = {});
  void addLines(const DegeneracyParams& degeneracy, const TrackChoice& choice = {});

  /// What a sighting says about the direction of the line's group alone.
  void addVanishing(const LineTrack& track, const LineSighting& sighting, const CameraPoses& poses,
                    const DegeneracyParams& degeneracy);

  /// Any residual. `loss` must outlive the factors.
  void add(std::unique_ptr<ceres::CostFunction> cost, FactorBlocks blocks, const ceres::LossFunction* loss = nullptr);

  const std::vector<Factor>& factors() const { return factors_; }

 private:
  void addPoint(const PointTrack& track);
  void addLine(const LineTrack& track, const CameraPoses& poses, const DegeneracyParams& degeneracy);
  void setStructuralLoss(const DegeneracyParams& degeneracy);

  const FrameMotion& motionOf(FrameId id) const { return motions_.at(id); }

  const SlidingWindow& window_;
  const FactorParams& params_;
  ceres::CauchyLoss point_loss_, line_loss_;
  const TrackNoise point_noise_, line_noise_;
  std::unique_ptr<ceres::LossFunction> structural_loss_, calibration_loss_;
  std::map<FrameId, FrameMotion> motions_;
  std::vector<Factor> factors_;
  // factors of images are many, and all go together
  std::unique_ptr<std::pmr::monotonic_buffer_resource> memory_;
  std::pmr::deque<PointFactor> point_factors_;
  std::pmr::deque<LineFactor> line_factors_;
  std::vector<std::unique_ptr<ceres::CostFunction>> others_;
};

}  // namespace lintel
