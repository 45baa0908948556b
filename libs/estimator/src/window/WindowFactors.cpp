// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowFactors.h"

#include <cmath>

#include "landmarks/LineDegeneracy.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/factors/AxesImuFactor.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/factors/VanishingFactor.h"

namespace lintel {

namespace {

constexpr std::size_t kFirstMemory = 1 << 20;  // [bytes] about what a full window needs

TrackNoise pointNoise(const FactorParams& params) {
  const double unit = params.point_sigma_px;
  return {kindsAbout({params.point_noise_px / unit, params.point_walk_px / unit}), params.track_freedom};
}

TrackNoise lineNoise(const FactorParams& params) {
  const double unit = params.line_sigma_px;
  return {kindsAbout({params.line_noise_px / unit, params.line_walk_px / unit}), params.track_freedom};
}

}  // namespace

WindowFactors::WindowFactors(const SlidingWindow& window, const FactorParams& params)
    : window_(window),
      params_(params),
      point_loss_(params.point_loss_width),
      line_loss_(params.line_loss_width),
      point_noise_(pointNoise(params)),
      line_noise_(lineNoise(params)),
      memory_(std::make_unique<std::pmr::monotonic_buffer_resource>(kFirstMemory)),
      point_factors_(memory_.get()),
      line_factors_(memory_.get()) {
  for (const WindowFrame& frame : window.frames) motions_[frame.id] = frame.bodyMotion();
}

void WindowFactors::addAll(const EstimatorParams& params, const Pose& T_b_c_calibrated) {
  addPriors();
  addGauge();
  addCalibrationPriors(params.calibration, T_b_c_calibrated);
  addAxesPrior(params.calibration);
  addMeasurements(params);
}

void WindowFactors::addMeasurements(const EstimatorParams& params, const TrackChoice& choice) {
  addImu();
  addRest(params);
  addPoints(choice);
  addLines(params.degeneracy, choice);
}

void WindowFactors::add(std::unique_ptr<ceres::CostFunction> cost, FactorBlocks blocks,
                        const ceres::LossFunction* loss) {
  factors_.push_back({cost.get(), loss, std::move(blocks)});
  others_.push_back(std::move(cost));
}

void WindowFactors::addPriors() {
  for (const WindowPrior& prior : window_.priors) factors_.push_back(factorOf(prior));
}

void WindowFactors::addCalibrationPriors(const CalibrationParams& params, const Pose& T_b_c_calibrated) {
  calibration_loss_ = std::make_unique<ceres::CauchyLoss>(params.loss_width);
  const auto addPart = [&](PriorPart& part, BlockKey::Kind kind, const ceres::LossFunction* loss) {
    if (part.refined) add(std::move(part.factor), {{kind, 0}}, loss);
  };
  PriorParts extrinsics = makeExtrinsicsPriors(params, T_b_c_calibrated);
  addPart(extrinsics[0], BlockKey::kExtrinsics, window_.scale_known ? calibration_loss_.get() : nullptr);
  addPart(extrinsics[1], BlockKey::kExtrinsics, calibration_loss_.get());
  for (PriorPart& part : makeCorrectionPriors(params)) addPart(part, BlockKey::kCorrection, calibration_loss_.get());
}

void WindowFactors::addAxesPrior(const CalibrationParams& params) {
  PriorPart part = makeAxesPrior(window_.axes, params);
  if (part.refined) add(std::move(part.factor), {{BlockKey::kAxes, 0}});
}

void WindowFactors::addGauge() {
  const WindowFrame& oldest = window_.frames.front();
  add(makeGaugePrior(oldest.pose), {{BlockKey::kPose, oldest.id}});
}

void WindowFactors::addImu() {
  for (std::size_t i = 1; i < window_.frames.size(); ++i) {
    const WindowFrame &before = window_.frames[i - 1], &frame = window_.frames[i];
    if (!frame.imu || frame.imu->dt_s() <= 0) continue;
    add(std::make_unique<AxesImuFactor>(frame.imu, window_.mean_f), {{BlockKey::kPose, before.id},
                                                                     {BlockKey::kMotion, before.id},
                                                                     {BlockKey::kPose, frame.id},
                                                                     {BlockKey::kMotion, frame.id},
                                                                     {BlockKey::kMeanBias, 0},
                                                                     {BlockKey::kAxes, 0}});
  }
}

void WindowFactors::addRest(const EstimatorParams& params) {
  for (std::size_t i = 0; i < window_.frames.size(); ++i) {
    const WindowFrame& frame = window_.frames[i];
    if (frame.at_rest) add(makeRestPrior(params.rest_velocity_sigma), {{BlockKey::kMotion, frame.id}});
    if (!frame.still || i == 0) continue;
    const WindowFrame& before = window_.frames[i - 1];
    add(makeStillPrior(before.pose, params.rest_position_sigma),
        {{BlockKey::kPose, before.id}, {BlockKey::kPose, frame.id}});
  }
}

void WindowFactors::addPoints(const TrackChoice& choice) {
  for (const auto& [id, track] : window_.points)
    if (track.triangulated && choice.point(track)) addPoint(track);
}

void WindowFactors::addPoint(const PointTrack& track) {
  if (track.sightings.size() < 2) return;  // one sighting says nothing about the cameras
  const double sigma_px = window_.noise_scales.points * params_.point_sigma_px;
  for (const PointSighting& s : track.sightings) {
    point_factors_.emplace_back(s.px, window_.camera(), motionOf(s.frame), track.origin_w, sigma_px,
                                window_.rowTime(s.seen_px));
    factors_.push_back({&point_factors_.back(),
                        &point_loss_,
                        {{BlockKey::kPose, s.frame},
                         {BlockKey::kExtrinsics, 0},
                         {BlockKey::kCorrection, 0},
                         {BlockKey::kPoint, track.id}},
                        &point_noise_});
  }
}

void WindowFactors::addLines(const DegeneracyParams& degeneracy, const TrackChoice& choice) {
  const CameraPoses poses(window_);
  for (const auto& [id, track] : window_.lines)
    if (choice.line(track) && entersProblem(track, degeneracy)) addLine(track, poses, degeneracy);
}

/// With what ties it to its group, if it has one.
void WindowFactors::addLine(const LineTrack& track, const CameraPoses& poses, const DegeneracyParams& degeneracy) {
  if (!track.distance_known) {
    for (const LineSighting& s : track.sightings) addVanishing(track, s, poses, degeneracy);
    return;
  }
  if (track.sightings.size() < 2) return;  // one sighting says nothing about the cameras
  const double scale = window_.noise_scales.lines * params_.line_sigma_px;
  // That a shutter rolls is for points to say: a start with a wrong scale would bend lines by a readout for long.
  const auto rowOf = [this](const Eigen::Vector2d& seen_px) {
    return window_.unrolled_s == 0 ? RowTime{} : window_.rowTime(seen_px);
  };
  for (const LineSighting& s : track.sightings) {
    line_factors_.emplace_back(s.start, s.end, motionOf(s.frame), track.origin_w, scale * s.sigma_px,
                               rowOf(s.seen_start_px), rowOf(s.seen_end_px));
    factors_.push_back({&line_factors_.back(),
                        &line_loss_,
                        {{BlockKey::kPose, s.frame},
                         {BlockKey::kExtrinsics, 0},
                         {BlockKey::kCorrection, 0},
                         {BlockKey::kLine, track.id}},
                        &line_noise_});
  }
  if (track.group == 0) return;
  setStructuralLoss(degeneracy);
  add(std::make_unique<SharedDirectionFactor>(1 / degeneracy.structural_sigma_rad),
      {{BlockKey::kLine, track.id}, {BlockKey::kDirection, track.group}}, structural_loss_.get());
}

void WindowFactors::addVanishing(const LineTrack& track, const LineSighting& s, const CameraPoses& poses,
                                 const DegeneracyParams& degeneracy) {
  setStructuralLoss(degeneracy);
  const double sigma = planeSigma(poses, params_, s, window_.directions.at(track.group).d_w);
  add(std::make_unique<VanishingFactor>(s.start, s.end, motionOf(s.frame),
                                        1 / std::hypot(sigma, degeneracy.structural_sigma_rad)),
      {{BlockKey::kPose, s.frame},
       {BlockKey::kExtrinsics, 0},
       {BlockKey::kCorrection, 0},
       {BlockKey::kDirection, track.group}},
      structural_loss_.get());
}

void WindowFactors::setStructuralLoss(const DegeneracyParams& degeneracy) {
  if (!structural_loss_) structural_loss_ = std::make_unique<ceres::CauchyLoss>(degeneracy.structural_loss_width);
}

}  // namespace lintel
