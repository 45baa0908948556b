// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Odometry.h"

#include <cstdio>
#include <exception>
#include <thread>

#include "lintel/core/BoundedQueue.h"
#include "lintel/mapping/LineSpacing.h"
#include "lintel/mapping/MapBuilder.h"
#include "lintel/tracking/FrontEnd.h"

namespace lintel {

namespace {

/// What tracking hands to estimation.
struct TrackedFrame {
  FrameWithImu step;
  FrameTracks tracks;
};

/// Estimation and mapping: the second half of the pipeline.
class BackEnd {
 public:
  BackEnd(const Rig& rig, const Configuration& configuration, const OdometryObserver& observer, OdometryResult& result)
      : rig_(rig),
        configuration_(configuration),
        estimator_(rig, configuration.estimator),
        map_(rig, configuration.map),
        refinement_(rig, configuration.estimator, configuration.map, configuration.refinement),
        observer_(observer),
        result_(result) {}

  void process(const TrackedFrame& frame) {
    OdometryStatistics& s = result_.statistics;
    WindowUpdate update;
    {
      const StageClock::Scope scope(s.estimation);
      update = estimator_.process(frame.tracks, frame.step.imu);
    }
    if (s.frames++ == 0) s.first_frame_ns = update.t_ns;
    s.last_frame_ns = update.t_ns;
    count(update);
    {
      const StageClock::Scope scope(s.mapping);
      map_.add(update);
    }
    if (update.hasPose()) result_.trajectory.push_back({update.t_ns, update.T_w_b});
    if (observer_) observer_(frame.step.frame, frame.tracks, update, s.frames);
  }

  void finish(const RefinementProgress& refining) {
    const CalibrationEstimate calibration = result_.window_calibration = estimator_.calibration();
    result_.rig = rig_;
    result_.rig.camera = calibration.camera;
    result_.rig.T_b_c = calibration.T_b_c;
    result_.time_offset_s = calibration.time_offset_s;
    map_.add(estimator_.finish());
    map_.setCalibration(result_.rig, result_.time_offset_s);
    finishMap(refining);
    OdometryStatistics& s = result_.statistics;
    s.keyframes = result_.map.keyframes.size();
    if (s.window_frames == 0) return;
    const auto n = static_cast<double>(s.window_frames);
    for (double* mean : {&s.mean_points_used, &s.mean_lines_tracked, &s.mean_lines_placed, &s.mean_lines_used,
                         &s.mean_lines_degenerate, &s.mean_lines_constrained, &s.mean_lines_through_epipole,
                         &s.mean_lines_direction_unknown, &s.mean_lines_distance_unknown})
      *mean /= n;
  }

 private:
  void finishMap(const RefinementProgress& refining) {
    MapMaterial material = map_.material();
    if (configuration_.refinement.enabled && !material.keyframes.empty()) {
      const StageClock::Scope scope(result_.statistics.refinement);
      result_.refinement = refinement_.refine(material, refining);
    } else {
      const StageClock::Scope scope(result_.statistics.map_fitting);
      prepareMaterial(configuration_.map, material);
    }
    if (result_.refinement.accepted) {
      result_.rig = material.rig;
      result_.time_offset_s = material.time_offset_s;
      for (const auto& [t_ns, T_w_b] : material.trajectory) result_.refined_trajectory.push_back({t_ns, T_w_b});
    }
    result_.map = drawMap(configuration_.map, material);
    result_.lines_beside = spaceLines(configuration_.map, result_.map);
  }

  void count(const WindowUpdate& update) {
    OdometryStatistics& s = result_.statistics;
    const double t_s = 1e-9 * static_cast<double>(update.t_ns - s.first_frame_ns);
    if (update.hasPose()) {
      ++s.frames_with_pose;
      if (s.first_pose_s < 0) s.first_pose_s = t_s;
    } else if (update.status == EstimatorStatus::kInitializing && update.reason != "between window frames") {
      s.last_wait = update.reason;
    }
    if (update.status == EstimatorStatus::kLost) {
      ++s.resets;
      char text[64];
      std::snprintf(text, sizeof text, "at %.2f s: ", t_s);
      s.failures.push_back(text + update.reason);
    }
    if (update.status != EstimatorStatus::kTracking) return;
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

  Rig rig_;
  const Configuration& configuration_;
  Estimator estimator_;
  MapBuilder map_;
  const BatchRefinement refinement_;
  const OdometryObserver& observer_;
  OdometryResult& result_;
};

/// Reading and tracking: the first half. False at the end of the recording; a fault ends it with `error` set.
class FirstHalf {
 public:
  FirstHalf(Recording& recording, const Configuration& configuration, OdometryResult& result)
      : recording_(recording), front_end_(recording.rig(), configuration.tracking), result_(result) {}

  std::optional<TrackedFrame> next() {
    TrackedFrame frame;
    try {
      auto step = recording_.next();
      if (!step) return std::nullopt;
      frame.step = std::move(*step);
      result_.statistics.decoding.add(frame.step.reading_ms);
    } catch (const RecordingError& e) {
      result_.error = e.what();
      return std::nullopt;
    }
    const StageClock::Scope scope(result_.statistics.tracking);
    frame.tracks = front_end_.process(frame.step.frame, frame.step.imu);
    return frame;
  }

  const FrontEndStatistics& statistics() const { return front_end_.statistics(); }

 private:
  Recording& recording_;
  FrontEnd front_end_;
  OdometryResult& result_;
};

void runOnTwoThreads(FirstHalf& first, BackEnd& back) {
  BoundedQueue<TrackedFrame> queue(4);
  std::exception_ptr failure;
  std::thread tracking([&] {
    try {
      while (auto frame = first.next())
        if (!queue.push(std::move(*frame))) break;
    } catch (...) {
      failure = std::current_exception();
    }
    queue.close();
  });
  try {
    while (auto frame = queue.pop()) back.process(*frame);
  } catch (...) {
    queue.close();
    tracking.join();
    throw;
  }
  tracking.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

OdometryResult runOdometry(Recording& recording, const Configuration& configuration, int threads,
                           const OdometryObserver& observer, const RefinementProgress& refining) {
  OdometryResult result;
  FirstHalf first(recording, configuration, result);
  BackEnd back(recording.rig(), configuration, observer, result);
  if (threads > 1) {
    runOnTwoThreads(first, back);
  } else {
    while (auto frame = first.next()) back.process(*frame);
  }
  back.finish(refining);
  result.statistics.front_end = first.statistics();
  return result;
}

}  // namespace lintel
