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

/// What an estimator makes of it.
struct Found {
  std::size_t first = 0;                                    ///< frame with a pose; 0: none
  Eigen::Vector3d bias_off = Eigen::Vector3d::Constant(1);  ///< of the last pose, from the true one [m/s^2]
};

Found estimated(const TrackedFlight& flight, const EstimatorParams& params, std::size_t frames) {
  Estimator estimator(flight.rig, params);
  Found found;
  for (std::size_t k = 0; k < frames; ++k) {
    const WindowUpdate update = estimator.process(flight.sim.frames[k].tracks, flight.sim.frames[k].imu);
    if (!update.hasPose()) continue;
    if (found.first == 0) found.first = k;
    found.bias_off = update.bias.accel - flight.truth(k).bias_accel;
  }
  return found;
}

TEST(LargeBias, AnAccelerometerThatIsFarOffAtZeroIsFoundOnceAStartWasRefused) {
  const Eigen::Vector3d bias(0.9, -0.6, 0.3);  // the data sheets of telephones' sensors allow 0.7 on each axis
  ASSERT_GT(bias.norm(), 4 * kParams.initializer.bias_accel_sigma);
  ASSERT_LT(bias.norm(), kParams.initializer.max_bias_accel);
  const TrackedFlight flight = flightWithAccelBias(bias);
  constexpr std::size_t kThreeSeconds = 60;
  const Found found = estimated(flight, kParams, flight.sim.frames.size());
  EXPECT_GT(found.first, 0u) << "no pose";
  EXPECT_LT(found.first, kThreeSeconds);
  EXPECT_LT(found.bias_off.norm(), 0.1);
  EstimatorParams firm = kParams;
  firm.initializer.late_bias_accel_sigma = firm.initializer.bias_accel_sigma;
  EXPECT_EQ(estimated(flight, firm, kThreeSeconds).first, 0u) << "refused";
}

}  // namespace
}  // namespace lintel
