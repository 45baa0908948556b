// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/Estimator.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ParamsCheck.h"
#include "initialisation/Initializer.h"
#include "initialisation/StartBuffer.h"
#include "initialisation/StartMemory.h"
#include "initialisation/StartReplacement.h"
#include "initialisation/StartTries.h"
#include "landmarks/LineDegeneracy.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/ParallelGroups.h"
#include "landmarks/PointTriangulation.h"
#include "lintel/core/FrameRate.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/inertial/Propagation.h"
#include "solver/WindowSolver.h"
#include "window/FailureDetection.h"
#include "window/KeyframeSelection.h"
#include "window/LandmarkCounts.h"
#include "window/NoiseScale.h"
#include "window/OutlierRejection.h"
#include "window/RestDetection.h"
#include "window/RollingShutter.h"
#include "window/ScaleDrift.h"
#include "window/WindowCovariance.h"
#include "window/WindowMarginalization.h"
#include "window/WindowMove.h"
#include "window/WindowNoise.h"
#include "window/WindowRetirement.h"
#include "window/WindowSigma.h"
#include "window/WindowStamps.h"

namespace lintel {

namespace {

// Window frames that a start is on trial: as long as the window reaches, and again.
constexpr int kTrialFrames = 30;
constexpr double kMostScaleSigma = 0.02;  // no prior takes points in before: it is linear, and as wrong as their scale

/// When a solve may end, see SolveLimits::min_move. After it mostly landmarks move, one by one: waiting for them took a
/// quarter of the solver's time and made the trajectory a few per cent better on average.
constexpr double kSettledMove = 0.3;

/// A start is solved to its minimum, next to undamped, and again with the frame after it, without the sightings that
/// did not fit: what its frames say of biases and scale is what the first poses and their covariances are made of.
constexpr int kStartIterations = 20;
constexpr double kStartTolerance = 1e-5, kStartDamping = 1e-8;

}  // namespace

class Estimator::Impl {
 public:
  Impl(const Rig& rig, const EstimatorParams& params)
      : rig_(rig),
        params_(paramsFor(rig.camera, params)),
        noise_(rig.imu_noise, params_.factors),
        rest_(params_),
        initializer_(params_, rig.T_b_c),
        window_(rig),
        point_noise_(params_.factors.track_freedom),
        line_noise_(params_.factors.track_freedom) {}

  WindowUpdate process(const FrameTracks& tracks, const ImuBatch& imu);
  WindowUpdate finish();
  CalibrationEstimate calibration() const {
    CalibrationEstimate estimate{window_.correctedCamera(),
                                 window_.T_b_c(),
                                 window_.correction[kTimeOffsetAt],
                                 window_.readout_s(),
                                 stampJitter_s(),
                                 followedBy(rig_.axes.A, window_.imuAxes().A),
                                 followedBy(rig_.axes.G, window_.imuAxes().G),
                                 {}};
    if (tracking_) estimate.sigma = windowSigma(window_, params_, rig_.T_b_c).calibration;
    return estimate;
  }

 private:
  bool entersWindow(const FrameTracks& tracks);
  bool appendImu(const FrameTracks& tracks, const ImuBatch& imu);
  WindowUpdate skipFrame(const FrameTracks& tracks);
  void addFrame(const FrameTracks& tracks);
  void remember(const FrameTracks& tracks);
  void initialise(WindowUpdate& update);
  std::string tryStart(SlidingWindow& buffer) const;
  void shortenBuffer();
  void startDrift(WindowUpdate& update);
  void track(WindowUpdate& update);
  void solve(WindowUpdate& update);
  void updateUncertainties();
  void repropagate();
  double stampJitter_s() const { return params_.calibration.find_stamp_jitter ? stamp_jitter_.sigma_s() : 0; }
  void shrink(bool second_newest_is_keyframe, WindowUpdate& update);
  void dropOldest(WindowUpdate& update);
  void dropSecondNewest(WindowUpdate& update);
  bool mayStartAnew() const { return !tracking_ || onTrial(); }
  bool onTrial() const { return tracking_ && tracks_since_start_ <= kTrialFrames; }
  void fail(Failure failure, const std::string& reason, WindowUpdate& update);
  void handOver(WindowUpdate& update);
  void clearWindow(bool keep_calibration);
  void fillFromMemory();
  void moveToAnchor();
  void fillPose(WindowUpdate& update);

  Rig rig_;
  EstimatorParams params_;
  WindowNoise noise_;
  RestDetection rest_;
  Initializer initializer_;
  SlidingWindow window_;
  PlacementCheck placement_;
  ScaleDrift scale_drift_;
  /// Before it moves nothing but the accelerometer says how far away points are. Where that may have correlated noise,
  /// it follows what noise of the images shows, and a take-off comes out with a wrong scale: it is taken to have none.
  bool started_at_rest_ = false;
  StampJitter stamp_jitter_;
  NoiseScale point_noise_, line_noise_;
  std::optional<WindowCovariance> sigma_;                        // of the last solve
  StateCovariance newest_covariance_ = StateCovariance::Zero();  // of the newest window frame
  bool tracking_ = false;
  int frames_since_entry_ = framesAtRate(params_.every_nth_frame, rig_.camera_rate_hz);  // into the window
  bool dark_ = false;                                                                    // the newest one shows nothing
  std::uint64_t poses_ = 0;
  FrameId next_frame_id_ = 0;
  ImuBatch pending_imu_;  // since the newest window frame
  std::int64_t newest_t_ns_ = 0;
  int blind_frames_ = 0, tracks_since_start_ = 0;
  Pose anchor_T_w_b_;  // where a new start continues

  StartMemory memory_;
  StartTries tries_;
  std::int64_t first_pose_ns_ = 0;                // of the present start
  std::optional<std::int64_t> replaces_from_ns_;  // first pose of the wrong start that is to be replaced
};

WindowUpdate Estimator::Impl::process(const FrameTracks& tracks, const ImuBatch& imu) {
  WindowUpdate update;
  update.t_ns = tracks.t_ns;
  const bool imu_ok = appendImu(tracks, imu);
  const bool enters = entersWindow(tracks);
  if (!imu_ok && !window_.frames.empty()) {
    fail(Failure::kInterrupted, "the IMU has a gap", update);
  } else if (!enters) {
    if (mayStartAnew() && !window_.frames.empty()) memory_.addSkipped(tracks.t_ns, window_.frames.front().t_ns);
    update = skipFrame(tracks);
  } else {
    remember(tracks);
    addFrame(tracks);
    tracking_ ? track(update) : initialise(update);
  }
  return update;
}

/// Every n-th frame, and instead of one that shows nothing the next that does. When there is none for a while, darkness
/// is what there is to be seen.
bool Estimator::Impl::entersWindow(const FrameTracks& tracks) {
  constexpr std::int64_t kWaits_ns = 500'000'000;
  if (++frames_since_entry_ < framesAtRate(params_.every_nth_frame, rig_.camera_rate_hz)) return false;
  const bool shows_nothing = tracks.points.empty() && tracks.lines.empty();
  if (shows_nothing && !dark_ && !window_.frames.empty() && tracks.t_ns - newest_t_ns_ < kWaits_ns) return false;
  dark_ = shows_nothing;
  frames_since_entry_ = 0;
  return true;
}

/// False when the samples do not cover the time since the frame before.
bool Estimator::Impl::appendImu(const FrameTracks& tracks, const ImuBatch& imu) {
  noise_.add(imu);
  const std::int64_t covered_from = pending_imu_.empty() ? newest_t_ns_ : pending_imu_.back().t_ns;
  for (const ImuSample& sample : imu)
    if (pending_imu_.empty() || sample.t_ns > pending_imu_.back().t_ns) pending_imu_.push_back(sample);
  constexpr std::int64_t kSlack_ns = 20'000'000;  // some IMU samples: clocks differ, and samples get lost
  return !imu.empty() && imu.front().t_ns <= covered_from + kSlack_ns && imu.back().t_ns >= tracks.t_ns - kSlack_ns;
}

WindowUpdate Estimator::Impl::skipFrame(const FrameTracks& tracks) {
  WindowUpdate update;
  update.t_ns = tracks.t_ns;
  update.reason = "between window frames";
  if (!tracking_) return update;
  Preintegration imu(biasOf(window_.frames.back().motion.data()), noise_.now(), rig_.gravity_m_s2);
  imu.append(withAxes(pending_imu_, window_.imuAxes()));
  const InertialState state = propagated(stateOf(window_.frames.back()), imu);
  update.T_w_b = state.T_w_b;
  update.T_w_b_image = poseOfImage(window_, state, gyroAtEnd(imu));
  update.v_w_b = state.v_w_b;
  update.bias = state.bias;
  update.covariance = propagatedCovariance(stateOf(window_.frames.back()), imu, newest_covariance_);
  update.status = EstimatorStatus::kPropagated;
  return update;
}

/// While a start may still prove wrong, what another one would be made of.
void Estimator::Impl::remember(const FrameTracks& tracks) {
  if (!mayStartAnew()) return memory_.clear();
  memory_.add(tracks, pending_imu_, static_cast<std::size_t>(std::min(kTrialFrames, params_.initializer.max_frames)));
}

void Estimator::Impl::addFrame(const FrameTracks& tracks) {
  WindowFrame frame;
  frame.id = next_frame_id_++;
  frame.t_ns = tracks.t_ns;
  if (!window_.frames.empty()) {
    const WindowFrame& before = window_.frames.back();
    frame.imu = std::make_shared<Preintegration>(biasOf(before.motion.data()), noise_.now(), rig_.gravity_m_s2);
    if (started_at_rest_) frame.imu->leaveOutCorrelatedNoise();
    frame.imu->append(pending_imu_);
    const InertialState state = propagated(stateOf(before), withAxes(*frame.imu, window_.imuAxes()));
    frame.pose = toBlock(state.T_w_b);
    frame.motion = before.motion;
    frame.motion.segment<3>(kVelocityAt) = state.v_w_b;
  }
  pending_imu_.erase(pending_imu_.begin(), pending_imu_.empty() ? pending_imu_.end() : pending_imu_.end() - 1);
  newest_t_ns_ = tracks.t_ns;
  if (!pending_imu_.empty()) frame.gyro = pending_imu_.back().gyro;
  window_.addFrame(std::move(frame), tracks);
  noise_.raise(window_);
  rest_.add(window_);
  unroll(window_);
}

void Estimator::Impl::initialise(WindowUpdate& update) {
  while (static_cast<int>(window_.frames.size()) > params_.initializer.max_frames) shortenBuffer();
  if (!tries_.due()) {
    update.reason = tries_.reason();
    return;
  }
  const bool full = static_cast<int>(window_.frames.size()) >= params_.initializer.max_frames;
  SlidingWindow buffer = window_;
  update.reason = tryStart(buffer);
  if (update.reason == kBiasImplausible) initializer_.expectLargerBias();
  if (full && tries_.mayBeShorter() && !update.reason.empty() && update.reason != kScaleUnknown) {
    buffer = newestHalf(window_);
    if (tryStart(buffer).empty()) update.reason.clear();
  }
  if (!update.reason.empty()) {
    if (full)
      tries_.failed(update.reason);
    else
      tries_.failedWhileGrowing(window_.frames.size(), update.reason);
    return;
  }
  window_ = std::move(buffer);
  tries_.reset();
  moveToAnchor();
  tracking_ = true;
  blind_frames_ = tracks_since_start_ = 0;
  window_.scale_known = false;
  unroll(window_);
  solve(update);
  addIntervals(window_, 1, stamp_jitter_);
  if (stampJitter_s() > 0) solve(update);
  scale_drift_.start(sigma_->relativeScaleSigma(window_));
  started_at_rest_ = window_.frames.back().at_rest;
  update.status = EstimatorStatus::kTracking;
  first_pose_ns_ = update.t_ns;
  startDrift(update);
  fillPose(update);
}

/// Makes a buffer a start; what it lacks, where it is none.
std::string Estimator::Impl::tryStart(SlidingWindow& buffer) const {
  buffer.stamp_sigma_s = stampJitter_s();
  buffer.frames.front().imu.reset();
  return initializer_.initialise(buffer);
}

/// Makes room in a full buffer. A frame that is left out between others has its pose from the IMU if it is replaced.
void Estimator::Impl::shortenBuffer() {
  const std::size_t k = tries_.forScale() ? frameToThinOut(window_) : 0;
  if (k > 0) memory_.addSkipped(window_.frames[k].t_ns, window_.frames.front().t_ns);
  leaveOut(k, window_);
}

/// Covariances are relative to the first pose from here on: that of the newest frame, or the first that replaces one of
/// a wrong start.
void Estimator::Impl::startDrift(WindowUpdate& update) {
  const WindowFrame& newest = window_.frames.back();
  std::vector<const WindowFrame*> frames;
  if (replaces_from_ns_) frames = framesToReplace(window_, *replaces_from_ns_);
  std::vector<StateCovariance> covariances;
  for (const WindowFrame* frame : frames)
    covariances.push_back(covariances.empty() ? sigma_->start(window_, frame->id) : sigma_->of(window_, *frame));
  newest_covariance_ = covariances.empty() ? sigma_->start(window_, newest.id) : sigma_->of(window_, newest);
  replacePoses(window_, frames, covariances, memory_, update);
  if (!update.replaced.empty()) first_pose_ns_ = update.replaced.front().t_ns;
  replaces_from_ns_.reset();
}

void Estimator::Impl::moveToAnchor() {
  const Eigen::AngleAxisd yaw(yawOf(anchor_T_w_b_.q), Eigen::Vector3d::UnitZ());
  moveWindow(window_, {Eigen::Quaterniond(yaw), anchor_T_w_b_.p});
}

void Estimator::Impl::track(WindowUpdate& update) {
  WindowFrame& newest = window_.frames.back();
  const Pose predicted = newest.T_w_b();
  newest.at_rest = rest_.atRest(window_);
  newest.still = rest_.imagesRest();
  const bool keyframe = secondNewestIsKeyframe(window_, params_);
  solve(update);
  addIntervals(window_, window_.frames.size() - 1, stamp_jitter_);
  newest.blind = pointsInNewest(window_) + linesInNewest(window_) < params_.failure.min_points && !newest.at_rest;
  blind_frames_ = newest.blind ? blind_frames_ + 1 : 0;
  ++tracks_since_start_;
  std::string failure = findFailure(window_, params_.failure, predicted);
  if (failure.empty() && onTrial() &&
      biasOf(window_.frames.back().motion.data()).accel.norm() > initializer_.mostBiasAccel()) {
    failure = "it led to an implausible accelerometer bias";
    initializer_.expectLargerBias();
  }
  if (failure.empty() && onTrial() && scale_drift_.leftStart()) failure = "its scale is not what later images show";
  if (failure.empty() && placement_.contradicted(onTrial()))
    failure = "most points that move in the images have no place that fits the estimated motion";
  if (!failure.empty()) return fail(onTrial() ? Failure::kWrongStart : Failure::kDiverged, failure, update);
  if (blind_frames_ > params_.failure.max_blind_frames)
    return fail(Failure::kInterrupted, "too few features are tracked", update);
  update.keyframe = keyframe;
  update.at_rest = newest.at_rest;
  update.blind = newest.blind;
  update.status = EstimatorStatus::kTracking;
  newest_covariance_ = sigma_->of(window_, window_.frames.back());
  shrink(keyframe, update);
  fillPose(update);
}

void Estimator::Impl::solve(WindowUpdate& update) {
  window_.relinearise();
  triangulatePoints(window_, params_.landmarks, params_.factors.point_sigma_px);
  triangulateLines(window_, params_);
  if (params_.degeneracy.lines == "constrain") groupParallelLines(window_, params_);
  window_.stamp_sigma_s = stampJitter_s();
  countStampJitter(window_.stamp_sigma_s, window_);
  window_.noise_scales = {point_noise_.scale(), line_noise_.scale()};
  WindowFactors factors(window_, params_.factors);
  factors.addAll(params_, rig_.T_b_c);
  const SolveLimits limits = tracks_since_start_ == 0
                                 ? SolveLimits{kStartIterations, kSettledMove, true, kStartTolerance, kStartDamping}
                                 : SolveLimits{params_.max_iterations, kSettledMove, true};
  scale_drift_.beforeSolve(window_);
  SolveSummary solved = solveWindow(window_, factors.factors(), params_.calibration, limits);
  if (params_.factors.find_track_noise) {
    point_noise_.add(solved.levels.points);
    line_noise_.add(solved.levels.lines);
  }
  update.iterations = solved.iterations;
  sigma_.emplace(std::move(solved.information));
  scale_drift_.afterSolve(window_);
  rejectOutliers(window_, params_.landmarks);
  placement_.add(window_);
  updateUncertainties();
  repropagate();
  countLandmarks(window_, params_.degeneracy, update);
}

void Estimator::Impl::updateUncertainties() {
  const CameraPoses poses(window_);
  for (auto& [id, track] : window_.lines)
    if (entersProblem(track, params_.degeneracy)) updateLineUncertainty(poses, params_, track);
  for (auto& [id, track] : window_.points)
    if (track.triangulated) updatePointUncertainty(poses, params_.factors.point_sigma_px, track);
}

/// Integrates anew where the biases have moved too far for a linear correction.
void Estimator::Impl::repropagate() {
  constexpr double kMostGyro = 0.01, kMostAccel = 0.1;  // [rad/s], [m/s^2]
  for (std::size_t i = 1; i < window_.frames.size(); ++i) {
    WindowFrame& frame = window_.frames[i];
    const ImuBias bias = biasOf(window_.frames[i - 1].motion.data());
    if (frame.imu && ((bias.gyro - frame.imu->bias().gyro).norm() > kMostGyro ||
                      (bias.accel - frame.imu->bias().accel).norm() > kMostAccel))
      frame.imu->repropagate(bias);
  }
}

/// The window of a start is larger: it loses a frame more with each that comes. A prior made of all of them at once
/// would be linearised where biases and scale are hardly known.
void Estimator::Impl::shrink(bool second_newest_is_keyframe, WindowUpdate& update) {
  const auto isTooLarge = [this] { return static_cast<int>(window_.frames.size()) > params_.keyframes; };
  if (!isTooLarge()) return;
  second_newest_is_keyframe ? dropOldest(update) : dropSecondNewest(update);
  if (isTooLarge()) dropOldest(update);
}

void Estimator::Impl::dropOldest(WindowUpdate& update) {
  const FrameId leaving = window_.frames.front().id;
  sigma_->holdNext(window_);
  EstimatorParams params = params_;
  const double scale_sigma = sigma_->relativeScaleSigma(window_);
  window_.scale_known |= scale_sigma < kMostScaleSigma;
  if (onTrial() || scale_sigma > kMostScaleSigma)
    params.landmarks.lasting_points = 0;  // they would be linearised at a wrong scale
  marginaliseOldest(window_, params, scale_drift_.takeUnexplainedChange(scale_sigma));
  retireTracks(window_, leaving, true, update);
  retireKeyframe(window_, 0, update);
  window_.removeFrame(leaving, true);
}

void Estimator::Impl::dropSecondNewest(WindowUpdate& update) {
  const FrameId leaving = window_.frames[window_.frames.size() - 2].id;
  sigma_->forget(window_, leaving);
  marginaliseSecondNewest(window_);
  retireTracks(window_, leaving, false, update);
  window_.removeFrame(leaving, false);
}

void Estimator::Impl::fail(Failure failure, const std::string& reason, WindowUpdate& update) {
  const bool start_was_wrong = failure == Failure::kWrongStart;
  update.reason = start_was_wrong ? "the start was wrong: " + reason : reason;
  // what a wrong start made of the calibration is wrong, too
  const bool keep_calibration = !onTrial() && window_.extrinsics.allFinite() && window_.correction.allFinite();
  if (tracking_) {
    update.status = EstimatorStatus::kLost;
    update.failure = failure;
    if (!start_was_wrong) handOver(update);
  }
  clearWindow(keep_calibration);
  tracking_ = false;
  tries_.reset();
  replaces_from_ns_.reset();
  if (start_was_wrong) {
    replaces_from_ns_ = first_pose_ns_;
    tries_.startWasWrong();
    fillFromMemory();
  } else {
    memory_.clear();
  }
}

/// What was known before the frame that failed.
void Estimator::Impl::handOver(WindowUpdate& update) {
  anchor_T_w_b_ = window_.frames[window_.frames.size() > 1 ? window_.frames.size() - 2 : 0].T_w_b();
  if (window_.frames.size() > 1) {
    const FrameId failed = window_.frames.back().id;
    WindowUpdate nothing;
    retireTracks(window_, failed, false, nothing);
    window_.removeFrame(failed, false);
  }
  retireAll(window_, update);
}

void Estimator::Impl::clearWindow(bool keep_calibration) {
  const SlidingWindow former = std::move(window_);
  window_ = SlidingWindow(rig_);
  if (keep_calibration) {
    window_.extrinsics = former.extrinsics;
    window_.correction = former.correction;
    window_.axes = former.axes;
    window_.mean_f = former.mean_f;
  } else {
    window_.extrinsics = toBlock(rig_.T_b_c);
    window_.correction.setZero();
    point_noise_ = line_noise_ = NoiseScale(params_.factors.track_freedom);
  }
  window_.relinearise();  // what comes in is linearised about what is kept
  placement_ = {};
  started_at_rest_ = false;
  pending_imu_.clear();
}

void Estimator::Impl::fillFromMemory() {
  for (const StartMemory::Input& input : memory_.inputs()) {
    pending_imu_ = input.imu;
    addFrame(input.tracks);
  }
}

void Estimator::Impl::fillPose(WindowUpdate& update) {
  const WindowFrame& newest = window_.frames.back();
  update.T_w_b = newest.T_w_b();
  update.T_w_b_image = poseOfImage(window_, stateOf(newest), newest.gyro);
  update.v_w_b = velocityOf(newest.motion.data());
  update.bias = biasOf(newest.motion.data());
  update.covariance = newest_covariance_;
  constexpr std::uint64_t kSigmaEvery = 10;  // a second: biases and their sigmas change slowly
  if (poses_++ % kSigmaEvery != 0) return;
  const Eigen::Matrix<double, 6, 1> sigma = newest_covariance_.diagonal().tail<6>().cwiseSqrt();
  update.bias_sigma = ImuBias{sigma.head<3>(), sigma.tail<3>()};
}

WindowUpdate Estimator::Impl::finish() {
  WindowUpdate update;
  if (window_.frames.empty()) return update;
  update.t_ns = window_.frames.back().t_ns;
  if (tracking_) retireAll(window_, update);
  window_ = SlidingWindow(rig_);
  tracking_ = false;
  pending_imu_.clear();
  memory_.clear();
  tries_.reset();
  replaces_from_ns_.reset();
  return update;
}

Estimator::Estimator(const Rig& rig, const EstimatorParams& params)
    : impl_((checkParams(params), std::make_unique<Impl>(rig, params))) {}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;
WindowUpdate Estimator::process(const FrameTracks& tracks, const ImuBatch& imu) { return impl_->process(tracks, imu); }
WindowUpdate Estimator::finish() { return impl_->finish(); }
CalibrationEstimate Estimator::calibration() const { return impl_->calibration(); }

}  // namespace lintel
