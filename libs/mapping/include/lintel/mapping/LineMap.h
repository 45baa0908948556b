// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lintel/core/PlaceView.h"
#include "lintel/core/Rig.h"
#include "lintel/geometry/Pose.h"
#include "lintel/geometry/Segment.h"
#include "lintel/mapping/ErrorDraws.h"
#include "lintel/mapping/MapPieces.h"

namespace lintel {

class Preintegration;

/// A keyframe of the map: its state, which the IMU leads to. Where the image was taken: KeyframeCameras.h.
struct MapKeyframe {
  std::uint64_t id = 0;
  std::int64_t t_ns = 0;
  Pose T_w_b;
  Eigen::Vector3d v_w_b = Eigen::Vector3d::Zero();       ///< [m/s]
  Eigen::Vector3d bias_gyro = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d bias_accel = Eigen::Vector3d::Zero();  ///< [m/s^2]
  /// The IMU from the keyframe before; null for the first of a piece, and where the map does not keep it.
  std::shared_ptr<const Preintegration> imu = nullptr;
  bool at_rest = false;
  double offset_change_s = 0;  ///< what the offset between the clocks has beside LineMap::time_offset_s
};

/// Where a keyframe saw a point.
struct MapPointObservation {
  std::uint64_t keyframe_id = 0;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();  ///< raw (distorted) pixels
};

struct MapPoint {
  std::uint64_t id = 0;
  Eigen::Vector3d p_w = Eigen::Vector3d::Zero();  ///< [m]
  double sigma_distance_m = 0;                    ///< standard deviation along the viewing ray
  std::int64_t first_t_ns = 0, last_t_ns = 0;
  std::vector<MapPointObservation> observations;  ///< ascending keyframe id
};

/// Where a keyframe saw a line. Start and end correspond to the map line's.
struct MapLineObservation {
  std::uint64_t keyframe_id = 0;
  Eigen::Vector2d start_px = Eigen::Vector2d::Zero(), end_px = Eigen::Vector2d::Zero();  ///< raw (distorted) pixels
};

/// Covariance of a line's position [m] and direction [rad] in the two directions across it, tangentBasis(direction), at
/// its middle: by the errors of its views alone. Zero: not known.
using LineCovariance = Eigen::Matrix<float, 4, 4, Eigen::DontAlign>;

/// A finite 3D line segment with its uncertainty and provenance.
struct MapLine {
  std::uint64_t id = 0;
  Segment3 segment_w;              ///< ends in the world [m]
  double sigma_direction_rad = 0;  ///< standard deviation of the direction in its worst plane
  double sigma_distance_m = 0;     ///< standard deviation of the position, worst way across the line
  std::int64_t first_t_ns = 0, last_t_ns = 0;
  bool degenerate = false;                       ///< its own observations do not determine direction or depth
  bool constrained = false;                      ///< direction taken from a group of parallel lines
  bool mapped = false;                           ///< found in images with the poses known; false: tracked
  int group = -1;                                ///< place in LineMap::groups, -1 = none
  std::vector<MapLineObservation> observations;  ///< ascending keyframe id
  LineCovariance covariance = LineCovariance::Zero();
};

/// Lines that are parallel: a vanishing direction of the scene.
struct MapGroup {
  std::string name;                                        ///< "vertical", "horizontal 1", "slanted 1", …
  Eigen::Vector3d direction_w = Eigen::Vector3d::UnitX();  ///< unit; the sign means nothing
  double spread_rad = 0;                                   ///< RMS angle of the members, weighted by length
};

/// Where lines meet.
struct MapCorner {
  Eigen::Vector3d p_w = Eigen::Vector3d::Zero();  ///< [m]
  double sigma_m = 0;                             ///< standard deviation, worst way, by the lines' views alone
  std::vector<std::uint64_t> lines;               ///< ids, ascending; at least two
};

/// A plane that lines of different directions lie in: n . p = offset.
struct MapPlane {
  std::string name;  ///< "floor", "ceiling", "wall 1", else "horizontal 1", "vertical 1", "slanted 1", …
  Eigen::Vector3d normal_w = Eigen::Vector3d::UnitZ();  ///< unit, to the side that the cameras are on
  double offset_m = 0;
  double spread_m = 0;                       ///< RMS distance of the lines' ends
  std::vector<std::uint64_t> lines, points;  ///< ids, ascending
};

/// What an image looked like, to find the place again. Tracks are ids of the map's points.
struct MapView {
  int piece = 0;  ///< place in LineMap::pieces
  PlaceView looks;
};

/// The product: keyframes, points and line segments in one world frame (z up); in several when it has pieces that
/// could not be joined.
struct LineMap {
  Rig rig;                                  ///< calibration in use at the end
  double time_offset_s = 0;                 ///< an image with stamp t shows the world at t + offset
  std::string configuration;                ///< effective configuration, YAML text
  std::string source;                       ///< name of the recording
  std::vector<MapKeyframe> keyframes;       ///< ascending id
  std::vector<MapPoint> points;             ///< ascending id
  std::vector<MapLine> lines;               ///< ascending id
  std::vector<MapGroup> groups;             ///< of parallel lines, the longest in sum first
  std::vector<MapPiece> pieces;             ///< ascending first keyframe; empty: there is one
  std::vector<std::string> recordings;      ///< names, of a map of several; pieces say which is whose
  std::vector<MapView> views;               ///< ascending piece and time; none where they are not kept
  std::vector<MapCorner> corners;           ///< in the order of their first lines
  std::vector<MapPlane> planes;             ///< the longest lines in sum first
  std::vector<CameraErrors> camera_errors;  ///< of the keyframes, in their order; empty: not known
  /// (t_ns, T_w_b) of every frame when its image was taken (ImagePoses.h), ascending within a piece.
  std::vector<std::pair<std::int64_t, Pose>> trajectory;
};

}  // namespace lintel
