// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lintel/estimator/Estimator.h"
#include "lintel/mapping/BatchRefinement.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/pipeline/Configuration.h"
#include "lintel/pipeline/StageClock.h"
#include "lintel/sensing/Recording.h"
#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// One pose of the causal trajectory.
struct OdometryPose {
  std::int64_t t_ns = 0;
  Pose T_w_b;
};

/// What a run counted.
struct OdometryStatistics {
  std::size_t frames = 0, frames_with_pose = 0, window_frames = 0, keyframes = 0, resets = 0;
  std::int64_t first_frame_ns = 0, last_frame_ns = 0;
  double first_pose_s = -1;  ///< after the first frame
  double mean_points_used = 0, mean_lines_tracked = 0, mean_lines_placed = 0, mean_lines_used = 0,
         mean_lines_degenerate = 0, mean_lines_constrained = 0;
  /// degenerate lines by their reason (LineVerdict)
  double mean_lines_through_epipole = 0, mean_lines_direction_unknown = 0, mean_lines_distance_unknown = 0;
  std::vector<std::string> failures;                   ///< time and reason of each reset
  std::string last_wait;                               ///< what initialisation waited for last
  StageClock decoding, tracking, estimation, mapping;  ///< a value a frame
  StageClock map_fitting, refinement;                  ///< once, after the last frame
  FrontEndStatistics front_end;
};

struct OdometryResult {
  std::vector<OdometryPose> trajectory;          ///< causal
  std::vector<OdometryPose> refined_trajectory;  ///< empty when there was no refinement or it was not accepted
  RefinementReport refinement;
  LineMap map;
  int lines_beside = 0;                    ///< known, but beside better seen ones: see map.spacing
  Rig rig;                                 ///< as refined
  CalibrationEstimate window_calibration;  ///< as the last window had it, before any batch refinement
  double time_offset_s = 0;
  OdometryStatistics statistics;
  std::string error;  ///< why the recording ended early; empty when it was read to its end
};

/// Called for every frame, from the calling thread: the frame, its tracks, and how many are done.
using OdometryObserver = std::function<void(const Frame&, const FrameTracks&, const WindowUpdate&, std::size_t)>;

/// Recording in, trajectory and map out. With `threads` > 1 tracking runs on a thread of its own; the result does not
/// depend on it. A recording that breaks off gives what was computed until then, with `error` set.
/// `refining` is told how much of the refinement after the last frame is done.
OdometryResult runOdometry(Recording& recording, const Configuration& configuration, int threads,
                           const OdometryObserver& observer, const RefinementProgress& refining = {});

}  // namespace lintel
