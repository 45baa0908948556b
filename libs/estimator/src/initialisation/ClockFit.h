// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "initialisation/EpipolarRotation.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"
#include "lintel/inertial/GyroPath.h"

namespace lintel {

/// Two frames and the rays of the points that both see, when their rows were exposed.
struct TimedPair {
  std::int64_t a_ns = 0, b_ns = 0;
  FramePair pair;
  std::vector<std::pair<double, double>> rows;  // of the rays: shares of the readout after a and b
};

/// Pairs of frames with enough common points whose surroundings, a clock offset and a readout away, the IMU covers.
std::vector<TimedPair> timedPairs(const std::vector<FrameTracks>& frames, const GyroPath& path, const Rig& rig);

/// How well a clock offset fits: the epipolar constraint of all pairs, their rays turned to the frames' times by the
/// gyroscope. The bias, and the readout where it is free, are where the search has come to. Pairs and samples must
/// outlive it.
class ClockFit {
 public:
  /// For a given readout; `width_rad` is that of the robust loss.
  ClockFit(const std::vector<TimedPair>& pairs, const ImuBatch& imu, double readout_s, double width_rad);

  /// From now on the readout is estimated as well.
  void freeReadout() { free_ = true; }

  /// It is the given one again.
  void holdReadout();

  /// The equations at an offset, bias and readout adjusted to it. The cost is that of the images alone.
  EpipolarSystem at(double offset_s);

  /// Of a residual for what all rows of a frame share. The points of one frame share errors (calibration): a pair
  /// counts as one observation, not every ray; pairs that overlap share the gyroscope's noise, and count as one.
  double variance(const EpipolarSystem& system) const { return overlap_ * varianceOfRows(system); }

  /// For what differs between the rows of a frame, which the gyroscope's noise does not.
  double varianceOfRows(const EpipolarSystem& system) const { return system.sum / static_cast<double>(pairs_.size()); }

  const Eigen::Vector3d& bias() const { return bias_; }
  double readout_s() const { return readout_s_; }

  /// As if the camera had not turned. What was turned before is lost.
  EpipolarSystem withoutGyro();

 private:
  void turn(std::int64_t offset_ns);
  void addPrior(EpipolarSystem& system) const;
  void step(const Eigen::Vector4d& change);

  const std::vector<TimedPair>& pairs_;
  const ImuBatch& imu_;
  double given_s_, width_rad_, overlap_, readout_s_ = 0;
  bool free_ = false;
  std::vector<FramePair> turned_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
};

/// Of a readout that is not as given, about the given one.
constexpr double kOtherReadout_s = 0.02;

}  // namespace lintel
