// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Velocity and gravity in closed form [DongSi2012]: with the gyro's rotations every camera position is linear in the
/// first velocity and in gravity, and so is every point's place along its first ray. All rays together give a linear
/// system; points are eliminated, |g| is kept by a Lagrange multiplier. Distances weigh as 1/depth after a first round,
/// so that errors count as angles; rays that disagree get less weight.
struct GravityAlignment {
  Eigen::Vector3d v_b0 = Eigen::Vector3d::Zero();  ///< velocity at the first frame, its body axes [m/s]
  Eigen::Vector3d g_b0 = Eigen::Vector3d::Zero();  ///< gravity, body axes of the first frame [m/s^2]
  std::vector<Eigen::Vector3d> p_b0_bk, v_b0_bk;   ///< of every window frame
  bool ok = false;
};

/// The pre-integrations must be at the gyro bias found before.
GravityAlignment alignGravity(const SlidingWindow& window);

/// min x^T A x - 2 b^T x with |x_tail3| = gravity_m_s2, x = (v, g): exposed for its test.
Eigen::Matrix<double, 6, 1> solveWithGravityNorm(const Eigen::Matrix<double, 6, 6>& A,
                                                 const Eigen::Matrix<double, 6, 1>& b, double gravity_m_s2);

}  // namespace lintel
