// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"
#include "lintel/geometry/PluckerLine.h"
#include "lintel/geometry/Pose.h"
#include "lintel/inertial/Propagation.h"

namespace lintel {

/// A keyframe that has left the window, with its last estimate.
struct RetiredKeyframe {
  FrameId id = 0;
  std::int64_t t_ns = 0;
  Pose T_w_b;
  Eigen::Vector3d v_w_b = Eigen::Vector3d::Zero();
  ImuBias bias;
  std::shared_ptr<const Preintegration> imu;  ///< from the keyframe before; null for the first of a run
  bool at_rest = false, blind = false;
  ImuAxes axes;                       ///< of its samples, as the window knew them when the keyframe left it
  std::optional<InertialState> next;  ///< the frame after it, by the same solve; none for the newest
  double offset_change_s = 0;         ///< what the offset between the clocks has beside that of all keyframes
};

/// A point that is not tracked any more.
struct RetiredPoint {
  TrackId id = 0;
  Eigen::Vector3d p_w = Eigen::Vector3d::Zero();
  double sigma_distance_m = 0;
  std::vector<PointSighting> sightings;  ///< in keyframes
  bool triangulated = true;              ///< false: position and sigma are not valid, it could not be triangulated
};

/// A line that is not tracked any more.
struct RetiredLine {
  TrackId id = 0;
  PluckerLine line_w;
  double sigma_direction_rad = 0, sigma_distance_m = 0;
  bool degenerate = false;
  std::uint64_t group = 0;              ///< parallel group whose direction it was tied to (constrained); 0: none
  std::vector<LineSighting> sightings;  ///< in keyframes
  bool triangulated = true;             ///< false: line and sigmas are not valid, it could not be triangulated
};

enum class EstimatorStatus {
  kInitializing,  ///< no pose yet
  kTracking,      ///< `T_w_b` is the window's estimate
  kPropagated,    ///< `T_w_b` is IMU propagation from the last estimate (frames that do not enter the window)
  kLost,          ///< failure: the window was given up at this frame, initialisation starts again
};

/// The reason of a frame without a pose where all that a start lacks is its scale.
inline constexpr char kScaleUnknown[] = "waiting for a motion that shows the scale";

/// Why the window was given up.
enum class Failure {
  kNone,
  kInterrupted,  ///< no data to go on with; what was estimated before holds
  kWrongStart,  ///< the estimate contradicts itself soon after the start: nothing since then holds, none is handed over
  kDiverged,    ///< the same later on: what was estimated before is handed over, but it was going wrong
};

/// The pose of a frame before the present one.
struct FramePose {
  std::int64_t t_ns = 0;
  Pose T_w_b, T_w_b_image;  ///< as in WindowUpdate
  StateCovariance covariance = StateCovariance::Zero();
};

/// What one frame changed.
struct WindowUpdate {
  std::int64_t t_ns = 0;
  EstimatorStatus status = EstimatorStatus::kInitializing;
  std::string reason;  ///< of waiting or failure, in words
  Pose T_w_b;          ///< the state: at t_ns
  Pose T_w_b_image;    ///< when the image was taken: later by what the window knows of the offset between the clocks
  Eigen::Vector3d v_w_b = Eigen::Vector3d::Zero();
  ImuBias bias;
  /// With a pose: of its error relative to the first pose of the start (WindowCovariance.h).
  StateCovariance covariance = StateCovariance::Zero();
  std::optional<ImuBias> bias_sigma;  ///< standard deviations, about once a second
  Failure failure = Failure::kNone;   ///< with kLost
  /// With the first pose of a start that replaces a wrong one: the frames before, since the wrong start or as far as
  /// the new one reaches back.
  std::vector<FramePose> replaced;
  std::vector<RetiredKeyframe> keyframes;
  std::vector<RetiredPoint> points;
  std::vector<RetiredLine> lines;

  // figures of this step
  int points_used = 0, lines_tracked = 0, lines_placed = 0, lines_used = 0, lines_degenerate = 0, iterations = 0;
  int lines_through_epipole = 0, lines_direction_unknown = 0, lines_distance_unknown = 0, lines_constrained = 0;
  double points_distance_m = 0;  ///< median distance of the points used from the newest pose; 0: none is used
  bool keyframe = false, at_rest = false;
  bool blind = false;  ///< the images show too little: the pose is the IMU's alone

  bool startWasWrong() const { return failure == Failure::kWrongStart; }
  bool hasPose() const { return status == EstimatorStatus::kTracking || status == EstimatorStatus::kPropagated; }
};

}  // namespace lintel
