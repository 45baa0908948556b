// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "TestWindow.h"
#include "lintel/estimator/Estimator.h"

namespace lintel {
namespace {

using namespace test;

/// What a flight's estimate is off by.
struct Off {
  int poses = 0;
  double bias_up_m_s2 = 0;  ///< of the accelerometer's bias upwards, mean over the second half
};

/// A flight where gravity is `true_m_s2`, estimated with `given_m_s2`.
Off offFor(double true_m_s2, double given_m_s2) {
  Rig rig = eurocRig();
  rig.gravity_m_s2 = true_m_s2;
  TrackSimulationParams tracks;
  tracks.duration_s = 10;
  tracks.max_points_per_frame = 80;
  tracks.max_lines_per_frame = 10;
  tracks.point_noise_px = tracks.line_noise_px = 0.3;
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracks, FigureTrajectory(), rig);
  flight.rig.gravity_m_s2 = given_m_s2;
  Estimator estimator(flight.rig, EstimatorParams{});
  Off off;
  int counted = 0;
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k) {
    const WindowUpdate update = estimator.process(flight.sim.frames[k].tracks, flight.sim.frames[k].imu);
    off.poses += update.hasPose();
    if (2 * k < flight.sim.frames.size() || update.status != EstimatorStatus::kTracking) continue;
    off.bias_up_m_s2 += (update.T_w_b.q * (update.bias.accel - flight.truth(k).bias_accel)).z();
    ++counted;
  }
  off.bias_up_m_s2 /= counted;
  return off;
}

TEST(OtherGravity, IsTakenFromTheRig) {
  for (const double gravity : {9.81, 9.71, 3.71}) {
    const Off off = offFor(gravity, gravity);
    EXPECT_GT(off.poses, 160) << gravity;
    EXPECT_LT(std::abs(off.bias_up_m_s2), 0.03) << gravity;
  }
}

TEST(OtherGravity, AWrongOneBecomesABiasOfTheAccelerometer) {
  const Off off = offFor(9.71, 9.81);
  EXPECT_GT(off.poses, 160);
  EXPECT_NEAR(off.bias_up_m_s2, -0.1, 0.03);
}

}  // namespace
}  // namespace lintel
