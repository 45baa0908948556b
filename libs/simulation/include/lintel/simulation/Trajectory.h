// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// The motion of the body at one instant.
struct KinematicState {
  Pose T_w_b;
  Eigen::Vector3d v_w_b = Eigen::Vector3d::Zero();    ///< [m/s]
  Eigen::Vector3d a_w_b = Eigen::Vector3d::Zero();    ///< [m/s^2], without gravity
  Eigen::Vector3d omega_b = Eigen::Vector3d::Zero();  ///< angular rate of b against w, in b [rad/s]
};

/// A smooth motion of the body, at least C3 in position and C2 in rotation, whose derivatives are exact: velocity,
/// acceleration and rate are the derivatives of the pose, not approximations.
class Trajectory {
 public:
  virtual ~Trajectory() = default;

  /// The state at `t_s`, in [0, duration()]; beyond, implementations extrapolate smoothly or hold still, never jump.
  virtual KinematicState at(double t_s) const = 0;

  /// [s]; infinity where the motion has no end.
  virtual double duration() const { return std::numeric_limits<double>::infinity(); }
};

/// Another motion's start held still for `static_s`, then brought smoothly (C3) to full speed within `ramp_s`.
class DelayedStart : public Trajectory {
 public:
  /// `static_s` >= 0, `ramp_s` > 0 [s].
  DelayedStart(std::shared_ptr<const Trajectory> motion, double static_s, double ramp_s = 2.0);

  KinematicState at(double t_s) const override;
  double duration() const override;

 private:
  std::shared_ptr<const Trajectory> motion_;
  double static_s_, ramp_s_;
};

}  // namespace lintel
