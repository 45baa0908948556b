// SPDX-License-Identifier: BSD-3-Clause
#include "EstimationStage.h"

#include <algorithm>

#include "lintel/core/Formatted.h"
#include "lintel/core/FreeMemory.h"
#include "lintel/mapping/FarLines.h"
#include "lintel/mapping/ImagePoses.h"
#include "lintel/mapping/LineSpacing.h"
#include "lintel/mapping/MapStructure.h"
#include "lintel/pipeline/RunCosts.h"

namespace lintel {

namespace {

/// Of the pose's part.
std::array<float, 21> triangleOf(const StateCovariance& covariance) {
  std::array<float, 21> triangle;
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) triangle[at++] = static_cast<float>(covariance(i, j));
  return triangle;
}

}  // namespace

PoseCovariance covarianceOf(const OdometryPose& pose) {
  PoseCovariance covariance;
  std::size_t at = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) covariance(i, j) = covariance(j, i) = static_cast<double>(pose.covariance[at++]);
  return covariance;
}

EstimationStage::EstimationStage(const Rig& rig, const Configuration& configuration, OdometryResult& result)
    : rig_(rig),
      configuration_(configuration),
      estimator_(rig, configuration.estimator),
      map_(rig, configuration.map),
      loops_(rig, configuration.loops),
      refinement_(rig, configuration.estimator, configuration.map, configuration.refinement),
      result_(result) {
  checkRanges(configuration.densification, "densification.");
  if (configuration.refinement.enabled && configuration.densification.enabled &&
      configuration.tracking.features == "points_lines")
    edges_.emplace(rig, configuration.densification);
}

WindowUpdate EstimationStage::process(const TrackedFrame& frame) {
  OdometryStatistics& s = result_.statistics;
  WindowUpdate update;
  {
    const StageClock::Scope scope(s.estimation);
    update = estimator_.process(frame.tracks, frame.step.imu);
  }
  count(update);
  {
    const StageClock::Scope scope(s.mapping);
    map_.add(update);
  }
  if (configuration_.refinement.enabled) {
    const StageClock::Scope scope(s.loops);
    loops_.add(frame.step.frame, frame.tracks.points, update);
  }
  if (edges_) edges_->add(frame.step.frame, update, s.edges);
  return update;
}

void EstimationStage::addPoses(const WindowUpdate& update) {
  std::vector<OdometryPose>& trajectory = result_.trajectory;
  for (const FramePose& frame : update.replaced)
    trajectory.push_back({frame.t_ns, frame.T_w_b_image, triangleOf(frame.covariance)});
  if (update.hasPose()) trajectory.push_back({update.t_ns, update.T_w_b_image, triangleOf(update.covariance)});
  if (update.startWasWrong()) return withdrawStart();
  if (update.status != EstimatorStatus::kLost) return;
  settled_poses_ = trajectory.size();
  settled_blind_ = result_.statistics.blind.size();
}

void EstimationStage::withdrawStart() {
  result_.trajectory.resize(settled_poses_);
  result_.statistics.blind.resize(settled_blind_);
  was_blind_ = false;
}

/// An IMU that ends before the last images does not interrupt the flight: nothing begins anew.
void EstimationStage::leaveOutEnd() {
  constexpr std::int64_t kLongest_ns = 500'000'000;
  OdometryStatistics& s = result_.statistics;
  if (!interrupted_ns_ || s.last_frame_ns - *interrupted_ns_ > kLongest_ns) return;
  --s.resets;
  s.failures.pop_back();
}

void EstimationStage::finish(const FinishOptions& options) {
  leaveOutEnd();
  const CalibrationEstimate calibration = result_.window_calibration = estimator_.calibration();
  result_.rig = rig_;
  result_.rig.camera = calibration.camera;
  result_.rig.T_b_c = calibration.T_b_c;
  result_.rig.line_delay_s = calibration.readout_s / rig_.camera.height;
  result_.time_offset_s = calibration.time_offset_s;
  map_.add(estimator_.finish());
  map_.setCalibration(result_.rig, result_.time_offset_s);
  finishMap(options);
  OdometryStatistics& s = result_.statistics;
  s.keyframes = result_.map.keyframes.size();
  if (s.window_frames == 0) return;
  const auto n = static_cast<double>(s.window_frames);
  for (double* mean : {&s.mean_points_used, &s.mean_lines_tracked, &s.mean_lines_placed, &s.mean_lines_used,
                       &s.mean_lines_degenerate, &s.mean_lines_constrained, &s.mean_lines_through_epipole,
                       &s.mean_lines_direction_unknown, &s.mean_lines_distance_unknown})
    *mean /= n;
}

void EstimationStage::refineMap(MapMaterial& material, const FinishOptions& options) {
  {
    const StageClock::Scope scope(result_.statistics.loops);
    result_.loops = loops_.find(material, options.loops);
  }
  const StageClock::Scope scope(result_.statistics.refinement);
  const PlaceReport& places = result_.loops.places;
  const auto joinWhatWasSeenAgain = [&](MapMaterial& start) {
    alignPieces(places.alignments, start);
    spreadDrift(sightingsOf(places, loops_.cameras()), start);
  };
  const bool seen_again =
      std::any_of(places.pairs.begin(), places.pairs.end(), [](const PlacePair& pair) { return pair.refusal.empty(); });
  result_.refinement = refinement_.refine(material, options.refinement, joinsOf(result_.loops),
                                          seen_again ? joinWhatWasSeenAgain : std::function<void(MapMaterial&)>());
  if (result_.refinement.accepted) loops_.measureDrift(material, result_.loops);
}

void EstimationStage::densifyMap(const MapParams& params, MapMaterial& material, const FinishOptions& options) {
  returnFreeMemory();
  const double before_ms = processTimeMs();  // it takes several threads
  result_.densification =
      densify(configuration_.densification, params, edges_->edges(), material, options.threads, options.densification);
  settleLines(params, material);
  result_.statistics.densification.add(processTimeMs() - before_ms);
}

void EstimationStage::finishMap(const FinishOptions& options) {
  MapMaterial material = map_.takeMaterial();
  const bool refine = configuration_.refinement.enabled && !material.keyframes.empty();
  if (refine && !result_.cancelled) {
    refineMap(material, options);
  } else {
    const StageClock::Scope scope(result_.statistics.map_fitting);
    if (refine) result_.refinement.verdict = "not refined: the run was cancelled";
    prepareMaterial(configuration_.map, material);
  }
  if (result_.refinement.accepted) {
    result_.rig = material.rig;
    result_.time_offset_s = material.time_offset_s;
    for (const auto& [t_ns, T_w_b] : posesOfImages(material)) result_.refined_trajectory.push_back({t_ns, T_w_b});
  }
  MapParams params = withFarLines(configuration_.map, material, configuration_.map.least_share);
  if (edges_ && !result_.cancelled) {
    densifyMap(params, material, options);
    params = withFarLines(params, material, params.least_share);
  }
  result_.map = drawMap(params, material);
  result_.map.configuration = writeConfiguration(configuration_);
  keepForMerging(material);
  result_.lines_beside = spaceLines(params, result_.map);
  findStructure(result_.map);
}

/// A place is recognised by views, and the poses of two flights are adjusted with the IMU between them.
void EstimationStage::keepForMerging(const MapMaterial& material) {
  result_.map.views = loops_.takeViews(result_.map, material);
  if (result_.map.views.empty())
    for (MapKeyframe& keyframe : result_.map.keyframes) keyframe.imu.reset();
}

/// After the first frame.
double EstimationStage::secondsOf(std::int64_t t_ns) const {
  return 1e-9 * static_cast<double>(t_ns - result_.statistics.first_frame_ns);
}

void EstimationStage::count(const WindowUpdate& update) {
  OdometryStatistics& s = result_.statistics;
  if (s.frames++ == 0) s.first_frame_ns = update.t_ns;
  s.last_frame_ns = update.t_ns;
  const double t_s = secondsOf(update.t_ns);
  addPoses(update);
  s.frames_with_pose = result_.trajectory.size();
  s.first_pose_s = result_.trajectory.empty() ? -1 : secondsOf(result_.trajectory.front().t_ns);
  if (update.hasPose()) {
    interrupted_ns_.reset();
    if (s.first_start_s < 0) s.first_start_s = t_s;
  } else if (update.status == EstimatorStatus::kInitializing && update.reason != "between window frames") {
    if (++waits_[update.reason] >= waits_[s.main_wait]) s.main_wait = update.reason;
    ++s.frames_waiting;
    s.frames_without_scale += update.reason == kScaleUnknown ? 1 : 0;
  }
  if (update.status == EstimatorStatus::kLost) {
    ++s.resets;
    s.failures.push_back(formatted("at %.2f s: ", t_s) + update.reason);
    if (update.failure == Failure::kInterrupted) interrupted_ns_ = update.t_ns;
  }
  if (update.status == EstimatorStatus::kTracking) {
    countWindow(update);
    countBlind(update.blind, t_s);
  }
}

void EstimationStage::countBlind(bool blind, double t_s) {
  constexpr double kShortest_s = 0.5;
  std::vector<Stretch>& stretches = result_.statistics.blind;
  if (blind && !was_blind_) stretches.push_back({t_s, t_s});
  if (blind) stretches.back().to_s = t_s;
  if (!blind && was_blind_ && stretches.back().to_s - stretches.back().from_s < kShortest_s) stretches.pop_back();
  was_blind_ = blind;
}

/// Adds up what finish() divides by the number of windows.
void EstimationStage::countWindow(const WindowUpdate& update) {
  OdometryStatistics& s = result_.statistics;
  ++s.window_frames;
  s.mean_points_used += update.points_used;
  s.mean_lines_tracked += update.lines_tracked;
  s.mean_lines_placed += update.lines_placed;
  s.mean_lines_used += update.lines_used;
  s.mean_lines_degenerate += update.lines_degenerate;
  s.mean_lines_constrained += update.lines_constrained;
  s.mean_lines_through_epipole += update.lines_through_epipole;
  s.mean_lines_direction_unknown += update.lines_direction_unknown;
  s.mean_lines_distance_unknown += update.lines_distance_unknown;
}

}  // namespace lintel
