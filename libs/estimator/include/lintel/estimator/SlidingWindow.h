// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"
#include "lintel/factors/FrameMotion.h"
#include "lintel/factors/ImageObservations.h"
#include "lintel/factors/PriorFactors.h"
#include "lintel/factors/RowMotion.h"
#include "lintel/factors/StateBlocks.h"
#include "lintel/inertial/ImuAt.h"
#include "lintel/inertial/ImuAxes.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {

using FrameId = std::uint64_t;  ///< counts the frames that entered the window

/// Names a parameter block of the window. Blocks move in memory, keys stay.
struct BlockKey {
  enum Kind { kPose, kMotion, kExtrinsics, kCorrection, kMeanBias, kAxes, kDirection, kPoint, kLine };
  Kind kind = kPose;
  std::uint64_t id = 0;  ///< frame, direction, point or line; 0 for what is there once
  bool operator<(const BlockKey& o) const { return kind != o.kind ? kind < o.kind : id < o.id; }
  bool operator==(const BlockKey& o) const { return kind == o.kind && id == o.id; }
};

/// A state of the window.
struct WindowFrame {
  FrameId id = 0;
  std::int64_t t_ns = 0;
  PoseBlock pose = toBlock(Pose{});                ///< T_w_b
  MotionBlock motion = MotionBlock::Zero();        ///< velocity and biases
  std::shared_ptr<Preintegration> imu;             ///< from the frame before; null for the first
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();  ///< at t_ns, bias included [rad/s] (ImuAt.h)
  bool at_rest = false;                            ///< gets a zero-velocity observation
  bool still = false;                              ///< has not moved since the frame before (RestDetection)
  bool blind = false;                              ///< sees next to nothing that is placed: the IMU carries it

  /// The frame before leaves: the interval begins at the one before that.
  void joinInterval(const WindowFrame& before);

  Pose T_w_b() const { return poseFromBlock(pose.data()); }
  FrameMotion bodyMotion() const {
    return {T_w_b().q.conjugate() * velocityOf(motion.data()), gyro - biasOf(motion.data()).gyro};
  }
};

struct PointSighting {
  FrameId frame = 0;
  RayObservation observation;
  Eigen::Vector2d px = Eigen::Vector2d::Zero();       ///< at the frame's time
  Eigen::Vector2d seen_px = Eigen::Vector2d::Zero();  ///< in the image: at the time of its row (RollingShutter.h)
};

struct LineSighting {
  FrameId frame = 0;
  LineEnd start, end;
  Eigen::Vector2d start_px = Eigen::Vector2d::Zero(), end_px = Eigen::Vector2d::Zero();
  double sigma_px = 1;
  Eigen::Vector2d seen_start_px = Eigen::Vector2d::Zero(), seen_end_px = Eigen::Vector2d::Zero();
};

/// A point: homogeneous, world axes, relative to `origin_w` (PointFactor.h).
struct PointTrack {
  TrackId id = 0;
  std::vector<PointSighting> sightings;  ///< in window frames, in their order
  std::vector<PointSighting> former;     ///< in keyframes that have left the window, as observed then
  PointBlock point = PointBlock::Zero();
  Eigen::Vector3d origin_w = Eigen::Vector3d::Zero();
  double sigma_inverse_depth = 0;  ///< along the ray of the first sighting [1/m]; the best so far
  bool triangulated = false;
};

/// What the observations say about a line. From kThroughEpipole on it is degenerate.
enum class LineVerdict {
  kNone,  ///< not triangulated
  kGood,
  kThroughEpipole,    ///< the test of [Lim2021]: it lies in one plane with the motion
  kDirectionUnknown,  ///< by its information: LineDegeneracy.h
  kDistanceUnknown,
};

/// A direction that lines share.
struct SharedDirection {
  DirectionBlock d_w = DirectionBlock::UnitX();
  FrameId last_used = 0;  ///< newest frame that had a member
};

/// A line's estimate at an earlier time.
struct KnownLine {
  LineBlock line = LineBlock::Zero();
  Eigen::Vector3d origin_w = Eigen::Vector3d::Zero();
  double sigma_direction_rad = 0, sigma_distance_m = 0;
};

/// A line: world axes, moment about `origin_w`.
struct LineTrack {
  TrackId id = 0;
  std::vector<LineSighting> sightings;
  std::vector<LineSighting> former;
  LineBlock line = LineBlock::Zero();
  Eigen::Vector3d origin_w = Eigen::Vector3d::Zero();
  bool triangulated = false;
  LineVerdict verdict = LineVerdict::kNone;
  std::uint64_t group = 0;     ///< direction it is tied to; 0: none
  bool distance_known = true;  ///< false: in a group, and only its direction is known
  double sigma_direction_rad = 0, sigma_distance_m = 0;
  std::optional<KnownLine> best;  ///< when marginalisation used up its sightings, if it was good then

  bool degenerate() const { return verdict > LineVerdict::kGood; }
};

/// A prior over some blocks of the window.
struct WindowPrior {
  std::vector<BlockKey> blocks;
  std::shared_ptr<const PriorFactor> factor;
};

/// How far the window's world may have drifted since the start of the trajectory: a shift [m] and a turn about the
/// vertical through the origin [rad] that together take a position of the estimate to where it truly is, seen from the
/// first pose. Of this error c, the part that the window's states know about is K dx (dx: the error of the states in
/// the tangent spaces), the rest is independent of all that is measured later (WindowCovariance.h).
struct WorldDrift {
  using Rows = Eigen::Matrix<double, 4, Eigen::Dynamic>;
  std::map<BlockKey, Rows> by_state;                     ///< K, in columns of blocks
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of c, with the oldest frame's position and yaw held
};

/// The errors of tracks in units of the configured noise (FactorParams).
struct NoiseScales {
  double points = 1, lines = 1;
};

/// The states and tracks of the sliding window; what the other classes of this room work on, without any algorithm.
class SlidingWindow {
 public:
  explicit SlidingWindow(const Rig& rig);

  std::deque<WindowFrame> frames;        ///< ascending time; the last is the newest
  std::map<TrackId, PointTrack> points;  ///< ordered: the same sums in the same order every run
  std::map<TrackId, LineTrack> lines;
  double stamp_sigma_s = 0;  ///< by how much the images' stamps are off, as far as it is known (StampJitter.h)
  NoiseScales noise_scales;  ///< as far as they are known (NoiseScale.h)
  bool scale_known = true;   ///< to 2 %, at some time since the start
  std::map<std::uint64_t, SharedDirection> directions;  ///< of groups of parallel lines; ids from 1
  std::uint64_t next_direction = 1;
  PoseBlock extrinsics;  ///< T_b_c
  CorrectionBlock correction = CorrectionBlock::Zero();
  MeanBiasBlock mean_bias = MeanBiasBlock::Zero();
  AxesBlock axes = AxesBlock::Zero();
  Eigen::Vector3d mean_f = Eigen::Vector3d::Zero();  ///< ImuAxes::mean_f, the same since the start
  std::vector<WindowPrior> priors;                   ///< from marginalisation and from initialisation
  WorldDrift drift;                                  ///< since the first pose
  double unrolled_s = 0;  ///< the readout by which sightings have been moved to their frames' times [s]

  const Camera& camera() const { return camera_; }  ///< as calibrated; `correction` is on top
  Camera correctedCamera() const;
  double readout_s() const { return given_readout_s_ + correction[kReadoutAt]; }  ///< from first to last row
  Pose T_b_c() const { return poseFromBlock(extrinsics.data()); }

  bool contains(FrameId id) const;
  const WindowFrame& frame(FrameId id) const;  ///< throws std::out_of_range
  WindowFrame& frame(FrameId id);
  double* block(const BlockKey& key);  ///< throws std::out_of_range

  /// Appends a frame and its tracks. The angular rates of the last two are those of the samples around them then.
  void addFrame(WindowFrame frame, const FrameTracks& tracks);

  /// Linearises the observations about the present correction, when it has left what they are linear within; not those
  /// in frames that have left.
  void relinearise();

  /// The correction about which the observations are linear.
  const CorrectionBlock& linearisedAt() const { return linearised_at_; }

  /// Forgets a frame and its sightings (keeping them in `former` when it was a keyframe). Tracks keep their estimate.
  /// Does not touch priors.
  void removeFrame(FrameId id, bool keyframe);

  /// When the row of a pixel was exposed.
  RowTime rowTime(const Eigen::Vector2d& seen_px) const {
    return {shareOfReadout(seen_px), unrolled_s - given_readout_s_};
  }
  double shareOfReadout(const Eigen::Vector2d& seen_px) const { return rowShare(camera_, seen_px); }

  /// What the IMU measured at the i-th frame; nothing where its samples are not known.
  std::optional<ImuAt> imuAtFrame(std::size_t i, double reach_s = kImuReach_s) const;
  double gravity_m_s2() const { return gravity_m_s2_; }
  ImuAxes imuAxes() const { return axesFromBlock(axes.data(), mean_f); }

  Pose T_w_c(const WindowFrame& f) const { return f.T_w_b() * T_b_c(); }

  /// World position of a triangulated point; far away for one at infinity.
  Eigen::Vector3d positionOf(const PointTrack& track) const;

 private:
  Camera camera_;
  double given_readout_s_, gravity_m_s2_;
  CorrectionBlock linearised_at_ = CorrectionBlock::Zero();
};

}  // namespace lintel
