// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Frames of reference, named by one letter everywhere in Lintel:
//
//   w  world: z up, gravity (0, 0, -9.81) m/s^2 or as the rig says; origin and yaw are those of the first pose
//   b  body: the IMU
//   c  camera: x right, y down, z forward
//   l  line: the reference point a line's moment is taken about (PluckerLine.h)
//
// and where one place needs more:
//
//   a  any frame, in statements about transforms in general; the earlier of two bodies
//   e  the frame that an estimate is given in
//   n  body that flies ahead: x forward, y left, z up
//   s  a sensor
//   v  the vehicle that a recording's calibration is given in (EuRoC's B)
//
// Several of a kind carry an index of one character: b0, bi, c1.
//
// `T_a_b` maps coordinates in b to coordinates in a: p_a = T_a_b * p_b; neighbouring letters cancel,
// T_a_c = T_a_b * T_b_c. `R_a_b` is its rotation, `p_a_b` the origin of b in a. `v_w_b`: velocity of b seen in w.

#include <Eigen/Core>

namespace lintel {

/// Gravity of the EuRoC halls [m/s^2], and within 0.3 % that of every place on earth.
constexpr double kGravity = 9.81;

/// Gravity acceleration in the world frame, where its size is `gravity_m_s2`.
inline Eigen::Vector3d gravityW(double gravity_m_s2 = kGravity) { return {0.0, 0.0, -gravity_m_s2}; }

}  // namespace lintel
