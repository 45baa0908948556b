// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "lintel/geometry/Rotation.h"
#include "lintel/simulation/Trajectory.h"

namespace lintel {

/// Velocity, acceleration and rate against central differences of the pose over [from, to].
inline void expectConsistent(const Trajectory& trajectory, double from_s, double to_s, double tolerance = 1e-5) {
  const double h = 1e-4;
  for (double t = from_s; t < to_s; t += 0.0713) {
    const KinematicState before = trajectory.at(t - h), now = trajectory.at(t), after = trajectory.at(t + h);
    ASSERT_NEAR(((after.T_w_b.p - before.T_w_b.p) / (2 * h) - now.v_w_b).norm(), 0, tolerance) << "t = " << t;
    ASSERT_NEAR(((after.v_w_b - before.v_w_b) / (2 * h) - now.a_w_b).norm(), 0, 10 * tolerance) << "t = " << t;
    const Eigen::Vector3d rate = logRotation(before.T_w_b.q.conjugate() * after.T_w_b.q) / (2 * h);
    ASSERT_NEAR((rate - now.omega_b).norm(), 0, tolerance) << "t = " << t;
  }
}

}  // namespace lintel
