// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "TestWindow.h"
#include "lintel/estimator/Estimator.h"

namespace lintel {
namespace {

using namespace test;

/// Every sample of the accelerometer is off by `bias` [m/s^2] as well.
TrackedFlight flightWithAccelBias(const Eigen::Vector3d& bias) {
  TrackSimulationParams tracks;
  tracks.duration_s = 8;
  tracks.max_points_per_frame = 80;
  tracks.max_lines_per_frame = 10;
  tracks.point_noise_px = tracks.line_noise_px = 0.3;
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracks);
  for (SimulatedFrame& frame : flight.sim.frames) {
    for (ImuSample& sample : frame.imu) sample.accel += bias;
    frame.truth.bias_accel += bias;
  }
  return flight;
}

TEST(LargeBias, AnAccelerometerThatIsFarOffAtZeroIsFoundOnceAStartWasRefused) {
  const Eigen::Vector3d bias(0.9, -0.6, 0.3);  // the data sheets of telephones' sensors allow 0.7 on each axis
  ASSERT_GT(bias.norm(), 4 * kParams.initializer.bias_accel_sigma);
  ASSERT_LT(bias.norm(), kParams.initializer.max_bias_accel);
  const TrackedFlight flight = flightWithAccelBias(bias);
  Estimator estimator(flight.rig, EstimatorParams{});
  std::size_t first = 0;
  Eigen::Vector3d off = Eigen::Vector3d::Constant(1);
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k) {
    const WindowUpdate update = estimator.process(flight.sim.frames[k].tracks, flight.sim.frames[k].imu);
    if (!update.hasPose()) continue;
    if (first == 0) first = k;
    off = update.bias.accel - flight.truth(k).bias_accel;
  }
  EXPECT_GT(first, 0u) << "no pose";
  EXPECT_LT(first, 60u) << "three seconds";
  EXPECT_LT(off.norm(), 0.1);
}

}  // namespace
}  // namespace lintel
