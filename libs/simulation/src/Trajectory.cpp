// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/Trajectory.h"

#include <stdexcept>

namespace lintel {

namespace {

/// The warped time tau(t) and its two derivatives: at rest until 0, then a septic step of the rate from 0 to 1.
struct Warp {
  double tau = 0, rate = 0, rate_change = 0;
};

Warp warp(double t_s, double ramp_s) {
  if (t_s <= 0) return {};
  if (t_s >= ramp_s) return {t_s - 0.5 * ramp_s, 1, 0};
  const double u = t_s / ramp_s, u2 = u * u, u3 = u2 * u, u4 = u2 * u2;
  return {ramp_s * u4 * u * (7 + u * (-14 + u * (10 - 2.5 * u))), u4 * (35 + u * (-84 + u * (70 - 20 * u))),
          u3 * (140 + u * (-420 + u * (420 - 140 * u))) / ramp_s};
}

}  // namespace

DelayedStart::DelayedStart(std::shared_ptr<const Trajectory> motion, double static_s, double ramp_s)
    : motion_(std::move(motion)), static_s_(static_s), ramp_s_(ramp_s) {
  if (!motion_ || static_s < 0 || ramp_s <= 0)
    throw std::invalid_argument("DelayedStart: bad motion, static_s or ramp_s");
}

KinematicState DelayedStart::at(double t_s) const {
  const Warp w = warp(t_s - static_s_, ramp_s_);
  KinematicState state = motion_->at(w.tau);
  state.a_w_b = state.a_w_b * w.rate * w.rate + state.v_w_b * w.rate_change;  // chain rule, before v changes
  state.v_w_b *= w.rate;
  state.omega_b *= w.rate;
  return state;
}

double DelayedStart::duration() const { return motion_->duration() + static_s_ + 0.5 * ramp_s_; }

}  // namespace lintel
