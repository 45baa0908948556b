// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>

#include "lintel/inertial/Propagation.h"

namespace lintel {

/// Estimates by how much the stamps of images are off, each by an amount of its own (stamps of arrival, not of
/// exposure).
///
/// An image taken delta after its stamp shows an attitude that is omega delta further. Between two images the rotation
/// by the states and that by the gyroscope, which is integrated from stamp to stamp, then differ by
///   r = Log(delta_R^-1 R_i^-1 R_j) = omega_j delta_j - delta_R^-1 omega_i delta_i,
/// which lies along the axis that the body turns about. What lies across it is noise of images and gyroscope, and what
/// grows with the angle turned is the gyroscope's gain. With a gain g and turns by the angle phi
///   sigma^2 = sum((r_along - g phi)^2 - |r_across|^2 / 2) / sum(|omega_i|^2 + |omega_j|^2).
class StampJitter {
 public:
  /// An interval between two images, and the states at both ends.
  void add(const InertialState& from, const InertialState& to, const Preintegration& imu);

  /// Standard deviation of a stamp [s], of the last intervals in which the body turned; 0 where it is not significant,
  /// or too small to matter.
  double sigma_s() const;

 private:
  struct Interval {
    double along = 0, across2 = 0;  ///< of r [rad], [rad^2]
    double angle = 0;               ///< turned [rad]
    double rates2 = 0;              ///< |omega_i|^2 + |omega_j|^2 [rad^2/s^2]
  };

  std::deque<Interval> intervals_;
};

/// Counts in the covariance of an interval that the times of its ends are uncertain, sigma_s each and independently.
/// With a for accelerations in the world, seen from the body at the start as v is, the residuals (ImuFactor.h) change
/// with the end's time by (omega_j, a_j, v_j), with the start's by
///   -(delta_R^-1 omega_i, a_i + omega_i x delta_v, v_i + a_i dt + omega_i x delta_p).
/// Replaces what was counted before.
void countStampJitter(double sigma_s, const InertialState& from, const InertialState& to, Preintegration& imu);

}  // namespace lintel
