// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "lintel/core/Rig.h"
#include "lintel/estimator/WindowUpdate.h"
#include "lintel/inertial/ImuAxes.h"
#include "lintel/mapping/ErrorDraws.h"
#include "lintel/mapping/MapPieces.h"

namespace lintel {

/// Where a keyframe saw a point. Views keep only what cannot be computed again, and that to 1e-4 px: an hour has
/// millions of them.
struct PointView {
  std::uint32_t keyframe = 0;                    ///< a FrameId: 2^32 frames are years
  Eigen::Vector2f px = Eigen::Vector2f::Zero();  ///< raw (distorted) pixels
  bool inlier = true;                            ///< agrees with the estimate
};

/// Where a keyframe saw a line.
struct LineView {
  FrameId keyframe = 0;
  TrackId track = 0;  ///< that it belonged to: a merged line has several
  Eigen::Vector2f start_px = Eigen::Vector2f::Zero(), end_px = Eigen::Vector2f::Zero();  ///< raw (distorted) pixels
  float sigma_px = 1;
  bool inlier = true;
};

/// A point and all its views.
struct PointRecord {
  TrackId id = 0;
  TrackId track = 0;   ///< of the tracker: another one than `id` where a track outlived an interruption
  bool known = false;  ///< `p_w` is an estimate
  Eigen::Vector3d p_w = Eigen::Vector3d::Zero();
  double sigma_distance_m = 0;  ///< along the ray it was seen on
  double error_px = 0;          ///< mean over the inliers
  double extra_sigma_px = 0;    ///< of its views, beside that of all views
  std::vector<TrackId> joined;  ///< other tracks that were found to be of the same point
  std::vector<PointView> views;
};

/// An infinite line near where it was seen: a point in the middle of what was seen and a unit direction, with the
/// covariance of (position, direction) in the two directions across it, `tangentBasis(direction_w)`.
struct LineEstimate {
  Eigen::Vector3d middle_w = Eigen::Vector3d::Zero(), direction_w = Eigen::Vector3d::UnitX();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();

  double sigmaDirection() const;               ///< worst way [rad]
  double sigmaPosition(double along_m) const;  ///< worst way across, that far from the middle [m]
};

/// A point that lies on a line.
struct PointOnLine {
  Eigen::Vector3d p_w = Eigen::Vector3d::Zero();
  double sigma_m = 0;  ///< across the line
};

/// What a line is held to beside its views.
struct LineTie {
  Eigen::Vector3d direction_w = Eigen::Vector3d::UnitX();  ///< unit, shared with others; the sign means nothing
  double sigma_rad = 0;                                    ///< how parallel the lines are
  std::vector<PointOnLine> points;                         ///< that lie on it
};

/// A line and all its views.
struct LineRecord {
  TrackId id = 0;
  bool known = false;  ///< `estimate` is one
  LineEstimate estimate;
  double error_px = 0;         ///< mean distance of the inliers' ends from the projected line
  double distance_m = 0;       ///< from which it was seen, median
  bool parallel = false;       ///< may be parallel to others: where its views leave it open, these may make it known
  bool mapped = false;         ///< found with the poses known, not tracked
  std::optional<LineTie> tie;  ///< where its own views do not determine direction or position
  std::vector<LineView> views;
};

/// What a run collects for the map: all keyframes, points and lines with their views, and the causal trajectory.
/// Its size grows with the observations of keyframes.
struct MapMaterial {
  Rig rig;                                  ///< calibration that the poses belong to
  double time_offset_s = 0;                 ///< an image with stamp t shows the world at t + offset
  ImuAxes axes;                             ///< of the samples of the keyframes
  std::vector<RetiredKeyframe> keyframes;   ///< ascending id and time
  std::vector<MapPiece> pieces;             ///< ascending; empty: the IMU leads through all keyframes, or none is known
  std::vector<CameraErrors> camera_errors;  ///< of the keyframes, in their order; empty: not known
  std::vector<PointRecord> points;
  std::vector<LineRecord> lines;
  /// (t_ns, T_w_b) of every frame with a state, ascending: causal, and of the frames that a start was made of.
  std::vector<std::pair<std::int64_t, Pose>> trajectory;
};

}  // namespace lintel
