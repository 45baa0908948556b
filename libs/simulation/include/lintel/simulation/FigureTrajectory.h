// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "lintel/simulation/Trajectory.h"

namespace lintel {

/// The built-in figure: a lying eight with a hand's shaking on top, heading slowly round the room. All six axes are
/// excited; with the defaults speeds are 0.5 to 1.5 m/s, accelerations up to about 4 m/s^2, rates up to about 1 rad/s.
struct FigureParams {
  Eigen::Vector3d centre{0, 0, 1.6};           ///< of the volume flown in [m], world
  Eigen::Vector3d half_extent{2.2, 1.4, 0.6};  ///< the position never leaves centre +- half_extent [m]
  double period_s = 16;                        ///< of the eight
  double translation = 1;                      ///< scales the translation; 0 = pure rotation
  double rotation = 1;                         ///< scales the changes of attitude; 0 = pure translation
  double shake = 1;                            ///< scales the fast parts (0.7 to 1.3 Hz) of both
  double heading_rad = 0;                      ///< of the camera at the start, about z from x
  double turn_rate_rad_s = 0.2;                ///< mean rate of the heading (scaled by `rotation`)
  double sweep_rad = 0.5;                      ///< how far the camera looks to either side (scaled by `rotation`)
  double pitch_rad = 0.1;                      ///< the mean pitch, positive = down
  std::uint64_t seed = 0;                      ///< 0: the plain figure; else random phases

  template <class F>
  void fields(F&& field) {
    field("period_s", period_s);
    field("translation", translation);
    field("rotation", rotation);
    field("shake", shake);
    field("heading_rad", heading_rad);
    field("turn_rate_rad_s", turn_rate_rad_s);
    field("sweep_rad", sweep_rad);
    field("pitch_rad", pitch_rad);
    field("seed", seed);
  }
};

/// A constant, a drift and sines: value and two derivatives in closed form.
class HarmonicSum {
 public:
  struct Sine {
    double amplitude = 0, rate_rad_s = 0, phase_rad = 0;
  };
  double constant = 0, drift_per_s = 0;
  std::vector<Sine> sines;

  /// {value, first, second derivative} at t.
  std::array<double, 3> at(double t_s) const;
};

/// The figure as a trajectory of the body that carries a camera mounted with rotation `R_b_c`: the camera looks
/// horizontally at heading 0 when all angles are zero.
class FigureTrajectory : public Trajectory {
 public:
  explicit FigureTrajectory(const FigureParams& params = {});
  FigureTrajectory(const FigureParams& params, const Eigen::Quaterniond& R_b_c);

  KinematicState at(double t_s) const override;

 private:
  Eigen::Quaterniond R_n_b_;             // n: x forward along the optical axis, y left, z up
  std::array<HarmonicSum, 3> position_;  // x y z
  std::array<HarmonicSum, 3> attitude_;  // yaw pitch roll of n
};

}  // namespace lintel
