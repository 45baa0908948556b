// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "SigmaCheck.h"
#include "TrackingStage.h"
#include "lintel/core/Rig.h"
#include "lintel/inertial/AccelerometerCheck.h"
#include "lintel/inertial/NoiseMeter.h"
#include "lintel/inertial/Propagation.h"
#include "lintel/inertial/TurnCheck.h"
#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// Looks for contradictions in a run, while it goes on.
class RunCheck {
 public:
  /// `clock_offset_s`: by which the stamps have been corrected. `bias_gyro`: what is known of it before the estimator
  /// knows it [rad/s].
  explicit RunCheck(const Rig& rig, double clock_offset_s = 0,
                    const Eigen::Vector3d& bias_gyro = Eigen::Vector3d::Zero())
      : rig_(rig),
        clock_offset_s_(clock_offset_s),
        accelerometer_(rig.gravity_m_s2),
        turns_(rig.T_b_c.q),
        bias_gyro_(bias_gyro) {}

  /// A frame, as tracked, and what the estimator made of it.
  void add(const TrackedFrame& frame, const WindowUpdate& update);

  /// What the checks have measured, by name.
  std::map<std::string, double> evidence() const;

  /// Why the trajectory must not be trusted, with the likely cause; empty when nothing contradicts it. `estimated`: the
  /// rig as the run has refined it; `refinement`: of all keyframes, if it was accepted.
  std::string verdict(const OdometryStatistics& statistics, const Rig& estimated,
                      const RefinementReport& refinement = {}) const;

  /// What of the IMU's noise densities was not believed, in words; empty when all were.
  std::string noiseRemark() const { return lintel::noiseRemark(rig_.imu_noise, noise_); }

 private:
  struct Speed {
    std::int64_t t_ns;
    Eigen::Vector3d v_w_b;
  };

  void watchSpeed(const WindowUpdate& update);
  void watchImu(const WindowUpdate& update);
  void watchFailures(const WindowUpdate& update);
  /// Whether all keyframes' images and the IMU agree.
  bool agree(const RefinementReport& refinement) const;
  /// Of an estimate that is wrong; empty: none.
  std::string symptom(const OdometryStatistics& statistics, const Rig& estimated,
                      const RefinementReport& refinement) const;
  /// Where the residuals of the IMU are too large for its noise; empty: nowhere.
  std::string imuFault(const RefinementReport& refinement) const;
  std::string accelFault(const RefinementReport& refinement) const;
  std::string cause(const OdometryStatistics& s) const;  ///< what may be behind it; empty: unknown

  Rig rig_;
  double clock_offset_s_;
  AccelerometerCheck accelerometer_;
  NoiseMeter noise_;
  TurnCheck turns_;
  SigmaCheck sigma_;
  std::optional<InertialState> keyframe_;  ///< the last one that has left the window
  std::optional<InertialState> next_;      ///< the one after it, by the same solve
  std::vector<double> imu_misfits_;        ///< squared, of nine degrees of freedom, between keyframes as each left
  std::vector<double> accel_misfits_;      ///< of six, without the rotation, between keyframes of one solve
  std::vector<double> biases_gyro_, biases_accel_;
  Eigen::Vector3d bias_gyro_;
  std::string divergence_;           ///< the first; empty: none
  std::int64_t first_ns_ = -1;       ///< of the frames
  std::deque<Speed> speeds_;         ///< of the last seconds, without a reset in between
  double largest_acceleration_ = 0;  ///< that lasted as long [m/s^2]
};

}  // namespace lintel
