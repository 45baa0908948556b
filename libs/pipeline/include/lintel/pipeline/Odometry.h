// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lintel/densification/Densifier.h"
#include "lintel/estimator/Estimator.h"
#include "lintel/geometry/EulerAngles.h"
#include "lintel/mapping/BatchRefinement.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/pipeline/Configuration.h"
#include "lintel/pipeline/StageClock.h"
#include "lintel/places/PlaceSearch.h"
#include "lintel/sensing/Recording.h"
#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// One pose of a trajectory.
struct OdometryPose {
  std::int64_t t_ns = 0;
  Pose T_w_b;
  /// Upper triangle by rows of the covariance of its error in (p, theta) (EulerAngles.h), relative to the first pose
  /// since the start before; zero where it is not known.
  std::array<float, 21> covariance{};
};

PoseCovariance covarianceOf(const OdometryPose& pose);

/// A stretch of a recording, in seconds after its first frame.
struct Stretch {
  double from_s = 0, to_s = 0;
};

/// What a run counted.
struct OdometryStatistics {
  std::size_t frames = 0, frames_with_pose = 0, window_frames = 0, keyframes = 0, resets = 0;
  std::int64_t first_frame_ns = 0, last_frame_ns = 0;
  double first_pose_s = -1;   ///< of the trajectory, after the first frame
  double first_start_s = -1;  ///< the same, of a start that proved wrong and was withdrawn, too
  double mean_points_used = 0, mean_lines_tracked = 0, mean_lines_placed = 0, mean_lines_used = 0,
         mean_lines_degenerate = 0, mean_lines_constrained = 0;
  /// degenerate lines by their reason (LineVerdict)
  double mean_lines_through_epipole = 0, mean_lines_direction_unknown = 0, mean_lines_distance_unknown = 0;
  std::vector<std::string> failures;                   ///< time and reason of each reset
  std::vector<Stretch> blind;                          ///< images showed too little: poses are the IMU's alone
  std::string main_wait;                               ///< what initialisation waited for in most frames
  std::size_t frames_waiting = 0;                      ///< window frames on which it waited
  std::size_t frames_without_scale = 0;                ///< of these, those on which it was the scale alone
  StageClock decoding, tracking, estimation, mapping;  ///< a value a frame
  StageClock loops;                                    ///< a value a described frame, and one for the search
  StageClock edges;                                    ///< a value a keyframe: the search for edges in its image
  StageClock map_fitting, refinement, densification;   ///< once, after the last frame
  FrontEndStatistics front_end;
};

/// Places that were seen again.
struct LoopResult {
  bool searched = false;               ///< not when they are left out, or when nothing is refined
  PlaceReport places;                  ///< times of the recording's images, poses of the causal trajectory
  std::vector<double> drift_before_m;  ///< of the causal trajectory, for every accepted pair
  std::vector<double> drift_after_m;   ///< of the refined one; empty when there is none
};

struct OdometryResult {
  std::vector<OdometryPose> trajectory;          ///< causal: what was known when the frame had been processed
  std::vector<OdometryPose> refined_trajectory;  ///< empty when there was no refinement or it was not accepted
  LoopResult loops;
  RefinementReport refinement;
  DensifyReport densification;
  LineMap map;                             ///< holds the configuration it was made with
  int lines_beside = 0;                    ///< known, but beside better seen ones: see map.spacing
  Rig rig;                                 ///< as refined
  CalibrationEstimate window_calibration;  ///< as the last window had it, before any batch refinement
  double time_offset_s = 0;
  double clock_offset_s = 0;                    ///< the part of it that the stamps were corrected by before the start
  std::shared_ptr<const GrayImage> found_mask;  ///< FrontEnd::foundMask; null: nothing moves with the camera
  OdometryStatistics statistics;
  std::vector<std::string> remarks;        ///< what was corrected of the recording's own data, in words
  std::map<std::string, double> evidence;  ///< what the checks of the run have measured, by name
  std::string verdict;                     ///< why trajectory and map are probably wrong; empty when no check fails
  std::string contradiction;               ///< why the causal trajectory is probably wrong, though the refined one
                                           ///< and the map are not; empty when they agree
  bool cancelled =
      false;          ///< RunOptions::cancelled ended the run: trajectory and map are those of the frames until then
  std::string error;  ///< why the recording ended early; empty when it was read to its end or cancelled

  /// The verdict, or else the contradiction.
  const std::string& fault() const { return verdict.empty() ? contradiction : verdict; }
};

/// The parts of a run that take time.
enum class RunStage { kFrames, kLoops, kRefinement, kDensification };

/// How much of a stage is done: frames of those that the recording is known to have (else `total` is 0), or percent of
/// the search for places seen again and of the refinement.
struct RunProgress {
  RunStage stage = RunStage::kFrames;
  std::size_t done = 0, total = 0;
};

/// Called for every frame: the frame, its tracks, what the estimator made of it, and how many are done.
using OdometryObserver = std::function<void(const Frame&, const FrameTracks&, const WindowUpdate&, std::size_t)>;

/// How a run is done; nothing of it changes trajectory or map, unless the run is cancelled. All functions are called
/// from the calling thread and may be empty; what they throw ends the run and reaches the caller.
struct RunOptions {
  int threads = 2;  ///< 1: one stage after the other; 2: tracking on a thread of its own, beside estimation
  std::function<void(const RunProgress&)> progress;
  std::function<bool()> cancelled;  ///< asked before every frame and every iteration of the refinement: true ends both
  OdometryObserver observer;
};

/// Recording and configuration in, trajectory and map out. A recording that breaks off gives what was computed until
/// then, with `error` set. A cancelled run gives what was computed until then as well, with `cancelled` set; a
/// refinement that had begun is given up. Throws std::invalid_argument when a parameter is out of range.
OdometryResult runOdometry(Recording& recording, const Configuration& configuration, const RunOptions& options = {});

}  // namespace lintel
