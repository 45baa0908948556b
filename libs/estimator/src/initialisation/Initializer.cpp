// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/Initializer.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>

#include "initialisation/GravityAlignment.h"
#include "initialisation/GyroAlignment.h"
#include "landmarks/PointTriangulation.h"
#include "lintel/core/Quantiles.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/estimator/WindowUpdate.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"
#include "solver/Marginals.h"
#include "solver/WindowSolver.h"
#include "window/ImuStatistics.h"
#include "window/OutlierRejection.h"
#include "window/WindowFactors.h"
#include "window/WindowStamps.h"

namespace lintel {

namespace {

constexpr double kNoLoss = 1e6;  // Cauchy width [standard deviations]
constexpr double kKnownOffset_s = 0.002, kKnownReadout_s = 0.001;
// Of k1 and k2, which move points at the image's corners by as many pixels as the focal length has hundreds.
constexpr double kKnownDistortion = 0.02;
// A start with k1 and k2 free is taken when it leaves less than this share of the squared residuals.
constexpr double kClearlyBetter = 0.6;
// An adjustment is left when the scale is less certain than asked for by this factor, before it and after its first
// rounds: what is left of it changes the scale's sigma by less.
constexpr double kHopelessBefore = 3, kHopelessAfter[] = {2, 1.5};
// A start whose median error is less than this share of the points' sigma is in the deepest minimum: in others errors
// are those of a wrong geometry.
constexpr double kUnambiguous = 0.5;
constexpr double kSomeAgree = 0.3;  // of the points: with fewer it is not the scale that is wrong
constexpr double kOtherScales[] = {0.5, 0.7, 1.4, 2};

/// The first rounds only have to show which points fit. The last one goes on to the minimum: along the scale, with the
/// biases and velocities that follow it, steps may lower the cost by less than the window's tolerance and yet change
/// the scale by tenths in all.
SolveLimits limitsOf(bool last_round) {
  SolveLimits limits{last_round ? 50 : 20};
  if (last_round) limits.tolerance = 1e-5;
  return limits;
}

/// Parallax from the oldest frame that shares enough points with the newest: where tracks are short none is shared with
/// the first.
double longestParallaxPx(const SlidingWindow& window) {
  const std::size_t newest = window.frames.size() - 1;
  double parallax = -1;
  for (std::size_t k = 0; k < newest && parallax < 0; ++k) parallax = medianDisparityPx(window, k, newest, true);
  return parallax;
}

}  // namespace

/// The calibration is held, but for a distortion that is not known: its errors are in the images' residuals, and common
/// to all tracks.
EstimatorParams Initializer::paramsAtStart(EstimatorParams params) {
  params.factors.point_sigma_px = params.factors.point_noise_px = params.initializer.point_sigma_px;
  params.factors.point_walk_px = 0;
  params.factors.track_freedom = std::numeric_limits<double>::infinity();
  params.factors.point_loss_width = params.initializer.point_loss_width;
  return params;
}

double medianDisparityPx(const SlidingWindow& window, std::size_t frame_a, std::size_t frame_b, bool rotation_free) {
  const FrameId a = window.frames[frame_a].id, b = window.frames[frame_b].id;
  Eigen::Quaterniond R_b0_b1 = Eigen::Quaterniond::Identity();  // 0 is frame_a, 1 is frame_b
  for (std::size_t k = frame_a + 1; rotation_free && k <= frame_b; ++k)
    R_b0_b1 = R_b0_b1 * window.frames[k].imu->deltaR();
  const Eigen::Quaterniond R_b_c = window.T_b_c().q, R_c0_c1 = R_b_c.conjugate() * R_b0_b1 * R_b_c;
  std::vector<double> disparities;
  for (const auto& [id, track] : window.points) {
    const PointSighting *in_a = nullptr, *in_b = nullptr;
    for (const PointSighting& s : track.sightings) {
      if (s.frame == a) in_a = &s;
      if (s.frame == b) in_b = &s;
    }
    if (!in_a || !in_b) continue;
    const Eigen::Vector3d turned = R_c0_c1 * in_b->observation.ray;
    if (!window.camera().wide() && turned.z() < 0.1) continue;
    disparities.push_back((window.camera().rayTo(turned) - in_a->observation.ray).norm());
  }
  return disparities.size() < 10 ? -1 : upperMedian(disparities) * window.camera().meanFocal();
}

void Initializer::expectLargerBias() {
  double& sigma = params_.initializer.bias_accel_sigma;
  sigma = std::max(sigma, params_.initializer.late_bias_accel_sigma);
}

bool Initializer::atRest(const SlidingWindow& window) const {
  const InitializerParams& p = params_.initializer;
  const ImuStatistics imu = imuStatistics(window, 1);
  if (imu.std_gyro > p.static_gyro_std || imu.std_accel > p.static_accel_std) return false;
  const double disparity = medianDisparityPx(window, 0, window.frames.size() - 1, false);
  return disparity >= 0 && disparity < p.static_disparity_px;
}

std::string Initializer::initialise(SlidingWindow& window) const {
  const auto n = static_cast<int>(window.frames.size());
  if (n < params_.initializer.min_frames) return "collecting frames";
  for (std::size_t k = 1; k < window.frames.size(); ++k)
    if (!window.frames[k].imu || window.frames[k].imu->dt_s() <= 0) return "waiting for IMU samples between all frames";
  return atRest(window) ? startStatic(window) : startMoving(window);
}

std::string Initializer::startStatic(SlidingWindow& window) const {
  const ImuStatistics imu = imuStatistics(window, 1);
  // the accelerometer at rest shows the reaction to gravity: straight up
  const Eigen::Quaterniond R_w_b = rotationBetween(imu.mean_accel, Eigen::Vector3d::UnitZ());
  MotionBlock motion = MotionBlock::Zero();
  motion.segment<3>(kBiasGyroAt) = imu.mean_gyro;
  for (WindowFrame& frame : window.frames) {
    frame.pose = toBlock(Pose{R_w_b, Eigen::Vector3d::Zero()});
    frame.motion = motion;
    frame.at_rest = true;
    if (!frame.imu) continue;
    frame.imu->repropagate(biasOf(motion.data()));
    frame.imu->leaveOutCorrelatedNoise();
  }
  levelAndCentre(window);
  setBiasPrior(window, motion, 0.005, params_.rest_velocity_sigma);
  return {};
}

std::string Initializer::startMoving(SlidingWindow& window) const {
  const double parallax = longestParallaxPx(window);
  const double half = medianDisparityPx(window, window.frames.size() / 2, window.frames.size() - 1, true);
  // With a full buffer waiting adds no parallax: the sigma of the scale decides then.
  const bool full = isFull(window);
  if (std::max(parallax, half) < params_.initializer.min_parallax_px * (full ? 0.5 : 1)) return "waiting for parallax";

  const GyroAlignment gyro = alignGyro(window);
  if (!gyro.ok) return "the gyroscope does not agree with the images";
  // Where parallax is small, a slow rotation and a slow translation look alike: the bias from the epipolar constraint
  // may then be off by more than a gyroscope's. Both are tried, and the measurements decide.
  std::string problem;
  std::optional<SlidingWindow> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& bias_gyro : {gyro.bias_gyro, Eigen::Vector3d(Eigen::Vector3d::Zero())}) {
    SlidingWindow trial = window;
    const std::string fault = tryMoving(bias_gyro, trial);
    if (problem.empty()) problem = fault;
    if (!fault.empty()) continue;
    if (const double misfit = misfitOf(trial); misfit < least) {
      least = misfit;
      best = std::move(trial);
    }
  }
  if (!best) return problem;
  window = std::move(*best);
  return {};
}

std::string Initializer::tryMoving(const Eigen::Vector3d& bias_gyro, SlidingWindow& trial) const {
  MotionBlock motion = MotionBlock::Zero();
  motion.segment<3>(kBiasGyroAt) = bias_gyro;
  for (WindowFrame& frame : trial.frames)
    if (frame.imu) {
      frame.imu = std::make_shared<Preintegration>(*frame.imu);
      frame.imu->repropagate({bias_gyro, Eigen::Vector3d::Zero()});
    }
  const GravityAlignment gravity = alignGravity(trial);
  if (!gravity.ok) return "waiting for a motion that shows scale and gravity";

  const Eigen::Quaterniond R_w_b0 = rotationBetween(gravity.g_b0, -Eigen::Vector3d::UnitZ());
  const std::vector<Eigen::Quaterniond> R_b0_bk = integratedRotations(trial);
  for (std::size_t k = 0; k < trial.frames.size(); ++k) {
    trial.frames[k].pose = toBlock(Pose{(R_w_b0 * R_b0_bk[k]).normalized(), R_w_b0 * gravity.p_b0_bk[k]});
    trial.frames[k].motion = motion;
    trial.frames[k].motion.segment<3>(kVelocityAt) = R_w_b0 * gravity.v_b0_bk[k];
  }
  levelAndCentre(trial);
  // Waiting does not help when the buffer is full: the start is judged when it has been adjusted.
  const bool full = isFull(trial);
  if (!adjustWithLens(full ? Gates::kNone : Gates::kHopeless, trial)) return kScaleUnknown;
  int candidates = 0;
  std::vector<double> errors = errorsPx(trial, candidates);
  const bool some_agree = static_cast<double>(errors.size()) > kSomeAgree * candidates;
  if (some_agree && upperMedian(errors) > kUnambiguous * params_.factors.point_sigma_px) tryOtherScales(trial);
  return verify(trial);
}

/// Where images are poor, the adjustment from the closed form may end in a minimum beside the deepest one.
void Initializer::tryOtherScales(SlidingWindow& best) const {
  const SlidingWindow adjusted = best;
  double least = misfitOf(best);
  for (const double factor : kOtherScales) {
    SlidingWindow trial = adjusted;
    for (auto& [id, track] : trial.points) track.triangulated = false;
    for (WindowFrame& frame : trial.frames) {
      const Pose T_w_b = frame.T_w_b();
      frame.pose = toBlock(Pose{T_w_b.q, factor * T_w_b.p});
      frame.motion.segment<3>(kVelocityAt) *= factor;
    }
    if (!adjustWithLens(Gates::kNone, trial)) continue;
    if (const double misfit = misfitOf(trial); misfit < least) {
      least = misfit;
      best = std::move(trial);
    }
  }
}

bool Initializer::isFull(const SlidingWindow& window) const {
  return static_cast<int>(window.frames.size()) >= params_.initializer.max_frames;
}

bool Initializer::adjustWithLens(Gates gates, SlidingWindow& trial) const {
  CalibrationParams held = params_.calibration;
  held.refine_camera &= isFull(trial);
  if (!distortionUnknown() || isFull(trial)) return adjust(held, gates, trial);
  SlidingWindow bent = trial;
  if (!adjust(held, gates, trial)) return false;
  if (adjust(params_.calibration, gates, bent) && misfitOf(bent) < kClearlyBetter * misfitOf(trial))
    trial = std::move(bent);
  return true;
}

bool Initializer::distortionUnknown() const {
  return params_.calibration.refine_camera && params_.calibration.distortion_sigma > kKnownDistortion;
}

double Initializer::misfitOf(SlidingWindow& window) const {
  const double limit = params_.landmarks.point_max_error_px, sigma = params_.factors.point_sigma_px;
  const CameraPoses poses(window);
  double sum = 0;
  for (const auto& [id, track] : window.points) {
    if (static_cast<int>(track.sightings.size()) < params_.landmarks.point_min_observations) continue;
    const double error = track.triangulated ? std::min(limit, reprojectionError(poses, track)) : limit;
    sum += static_cast<double>(track.sightings.size()) * error * error / (sigma * sigma);
  }
  WindowFactors factors(window, params_.factors);
  factors.addPriors();
  factors.addImu();
  factors.addAxesPrior(params_.calibration);
  if (isFull(window)) factors.addCalibrationPriors(refinedIn(window, params_.calibration), T_b_c_calibrated_);
  for (const Factor& factor : factors.factors()) {
    std::vector<const double*> blocks;
    for (const BlockKey& key : factor.blocks) blocks.push_back(window.block(key));
    Eigen::VectorXd residual(factor.cost->num_residuals());
    factor.cost->Evaluate(blocks.data(), residual.data(), nullptr);
    sum += residual.squaredNorm();
  }
  return sum;
}

CalibrationParams Initializer::refinedIn(const SlidingWindow& window, CalibrationParams calibration) const {
  if (isFull(window))
    calibration.loss_width = kNoLoss;
  else
    calibration.refine_extrinsics = false;
  // what is known from a search alone, to some milliseconds, would be taken for a bias
  calibration.refine_time_offset &= calibration.time_offset_sigma_s > kKnownOffset_s;
  calibration.refine_readout &= calibration.readout_sigma_s > kKnownReadout_s;
  return calibration;
}

bool Initializer::adjust(const CalibrationParams& calibration, Gates gates, SlidingWindow& window) const {
  setBiasPrior(window, MotionBlock::Zero(), params_.initializer.bias_gyro_sigma,
               std::numeric_limits<double>::infinity());
  const bool gated = gates == Gates::kHopeless;
  const CalibrationParams refined = refinedIn(window, calibration);
  LandmarkParams loose = params_.landmarks;
  // The first poses are rough: their errors are angles, and so are these limits.
  const double scale = pixelScale(window.camera());
  constexpr int kRounds = 3;
  static_assert(std::size(kHopelessAfter) == kRounds - 1);
  for (int round = 0; round < kRounds; ++round) {
    loose.point_max_error_px = round == 0 ? 30 * scale : round == 1 ? 8 * scale : params_.landmarks.point_max_error_px;
    triangulatePoints(window, loose, params_.factors.point_sigma_px);
    if (gated && round == 0 && !scaleWithin(kHopelessBefore, window)) return false;
    WindowFactors factors(window, params_.factors);
    factors.addPriors();
    factors.addImu();
    factors.addAxesPrior(params_.calibration);
    factors.addPoints();
    factors.addGauge();
    factors.addCalibrationPriors(refined, T_b_c_calibrated_);
    solveWindow(window, factors.factors(), refined, limitsOf(round + 1 == kRounds));
    window.relinearise();
    loose.point_max_error_px = round == 0 ? 8 * scale : params_.landmarks.point_max_error_px;
    const CameraPoses poses(window);
    for (auto& [id, track] : window.points)
      if (track.triangulated && reprojectionError(poses, track) > loose.point_max_error_px) track.triangulated = false;
    for (WindowFrame& frame : window.frames)
      if (frame.imu) frame.imu->repropagate(biasOf(frame.motion.data()));
    countStampJitter(window.stamp_sigma_s, window);
    if (gated && round + 1 < kRounds && !scaleWithin(kHopelessAfter[round], window)) return false;
  }
  return true;
}

/// Of the points with a place; `candidates` are all that could have one.
std::vector<double> Initializer::errorsPx(const SlidingWindow& window, int& candidates) const {
  const CameraPoses poses(window);
  std::vector<double> errors;
  candidates = 0;
  for (const auto& [id, track] : window.points) {
    if (static_cast<int>(track.sightings.size()) < params_.landmarks.point_min_observations) continue;
    ++candidates;
    if (track.triangulated) errors.push_back(reprojectionError(poses, track));
  }
  return errors;
}

std::string Initializer::verify(SlidingWindow& window) const {
  const InitializerParams& p = params_.initializer;
  int candidates = 0;
  std::vector<double> errors = errorsPx(window, candidates);
  if (errors.size() < 20 || static_cast<double>(errors.size()) < 0.6 * candidates)
    return "too few points agree with the motion";
  if (upperMedian(errors) > p.max_error_px) return "the images do not agree with the motion";
  if (biasOf(window.frames.back().motion.data()).accel.norm() > std::min(p.max_bias_accel, mostBiasAccel()))
    return kBiasImplausible;
  if (!scaleWithin(1, window)) return kScaleUnknown;
  return {};
}

/// A motion that has not shown the scale for long hardly will: the window, with its poses, may find it instead.
double Initializer::scaleSigmaFor(const SlidingWindow& window) const {
  const InitializerParams& p = params_.initializer;
  const double span_s = 1e-9 * static_cast<double>(window.frames.back().t_ns - window.frames.front().t_ns),
               grown = p.max_scale_sigma * span_s / p.patience_s;
  return std::max(p.max_scale_sigma, std::min(p.late_scale_sigma, grown));
}

bool Initializer::scaleWithin(double times, SlidingWindow& window) const {
  return relativeScaleSigma(window) < times * scaleSigmaFor(window);
}

double Initializer::relativeScaleSigma(SlidingWindow& window) const {
  WindowFactors factors(window, params_.factors);
  factors.addPriors();
  factors.addImu();
  factors.addAxesPrior(params_.calibration);
  factors.addPoints();
  factors.addGauge();
  std::set<BlockKey> frozen;
  const CalibrationParams refined = refinedIn(window, params_.calibration);
  if (isFull(window))
    factors.addCalibrationPriors(refined, T_b_c_calibrated_);
  else
    frozen = {{BlockKey::kExtrinsics, 0}, {BlockKey::kCorrection, 0}};
  if (!params_.calibration.refine_axes) frozen.insert({BlockKey::kAxes, 0});
  ReducedSystem system(window, factors.factors(), {}, frozen);
  if (isFull(window)) holdCalibration(system, refined);
  system.linearise();
  constexpr double kFloor = 1e-9;
  const Marginals marginals(system.eliminate(), kFloor);

  // The sigma of the distance to the frame farthest from the first.
  const Eigen::Vector3d from = window.frames.front().T_w_b().p;
  const auto distance = [&](const WindowFrame& frame) { return (frame.T_w_b().p - from).norm(); };
  const WindowFrame& farthest =
      *std::max_element(window.frames.begin(), window.frames.end(),
                        [&](const WindowFrame& a, const WindowFrame& b) { return distance(a) < distance(b); });
  const Eigen::Index place = marginals.offsetOf({BlockKey::kPose, farthest.id});
  if (!marginals.ok() || place < 0 || distance(farthest) < 1e-6) return std::numeric_limits<double>::infinity();
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(marginals.size());
  direction.segment<3>(place) = (farthest.T_w_b().p - from).normalized();
  return std::sqrt(marginals.variance(direction)) / distance(farthest);
}

void Initializer::setBiasPrior(SlidingWindow& window, const MotionBlock& mean, double gyro_sigma,
                               double velocity_sigma) const {
  const BlockKey first{BlockKey::kMotion, window.frames.front().id}, mean_bias{BlockKey::kMeanBias, 0};
  window.mean_bias = mean.segment<3>(kBiasAccelAt);
  window.mean_f = imuStatistics(window, 1).mean_accel;
  window.priors = {
      {{first, mean_bias}, makeFirstMotionPrior(mean, velocity_sigma, gyro_sigma, window.frames.back().imu->noise())},
      {{mean_bias}, makeMeanBiasPrior(window.mean_bias, params_.initializer)}};
}

void Initializer::levelAndCentre(SlidingWindow& window) const {
  const Pose first = window.frames.front().T_w_b();
  const Eigen::Quaterniond R(Eigen::AngleAxisd(-yawOf(first.q), Eigen::Vector3d::UnitZ()));
  for (WindowFrame& frame : window.frames) {
    const Pose T_w_b = frame.T_w_b();
    frame.pose = toBlock(Pose{(R * T_w_b.q).normalized(), R * (T_w_b.p - first.p)});
    frame.motion.segment<3>(kVelocityAt) = R * velocityOf(frame.motion.data());
  }
}

}  // namespace lintel
