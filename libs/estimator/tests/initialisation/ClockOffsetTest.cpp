// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/ClockOffset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

struct Span {
  std::vector<FrameTracks> frames;
  ImuBatch imu;
};

/// The first frames of a flight; an image with stamp t shows the world at t + offset of the IMU's clock.
Span spanOf(const TrackedFlight& flight, double offset_s) {
  Span span;
  for (const SimulatedFrame& frame : flight.sim.frames) {
    span.frames.push_back(frame.tracks);
    span.frames.back().t_ns -= std::llround(1e9 * offset_s);
    for (const ImuSample& sample : frame.imu)
      if (span.imu.empty() || sample.t_ns > span.imu.back().t_ns) span.imu.push_back(sample);
  }
  return span;
}

TrackedFlight turningFlight(double gyro_bias, double noise_px) {
  ImuSimulatorParams imu;
  imu.initial_gyro_bias = gyro_bias;
  TrackSimulationParams tracks;
  tracks.duration_s = 4;
  tracks.point_noise_px = noise_px;
  return fly(imu, tracks);
}

TEST(ClockOffset, IsFoundWhateverTheGyroBias) {
  for (const double bias : {0.0, 0.05}) {
    const TrackedFlight f = turningFlight(bias, 0.5);
    for (const double offset_s : {-0.083, -0.05, 0.0, 0.02, 0.071}) {
      const Span span = spanOf(f, offset_s);
      const ClockOffset found = findClockOffset(span.frames, span.imu, f.rig);
      EXPECT_TRUE(found.determined) << offset_s;
      EXPECT_NEAR(found.offset_s, offset_s, 0.004) << "bias " << bias;
      EXPECT_LT(found.rms_px, 2) << offset_s;
    }
  }
}

TEST(ClockOffset, IsNotFoundBeyondItsRange) {
  const TrackedFlight f = turningFlight(0.02, 0.5);
  const Span span = spanOf(f, 0.6);
  const ClockOffset found = findClockOffset(span.frames, span.imu, f.rig);
  EXPECT_TRUE(!found.determined || found.rms_px > 2) << found.offset_s << " " << found.rms_px;
}

/// A camera that does not turn and slides along by `step_m` a frame; both sensors have noise.
Span sliding(double step_m, double noise_px) {
  Span span;
  std::mt19937_64 engine(5);
  std::normal_distribution<double> noise(0, noise_px / plainRig().camera.meanFocal());
  for (int i = 0; i < 60; ++i) {
    FrameTracks frame;
    frame.t_ns = 50'000'000LL * (i + 10);
    for (TrackId id = 0; id < 40; ++id) {
      PointObservation p;
      p.id = id;
      const TrackId row = id / 8;
      const double z = 3 + static_cast<double>(id % 7);
      p.ray = {(static_cast<double>(id % 8) - 4 + step_m * i) / z + noise(engine),
               (static_cast<double>(row) - 2.5) / z + noise(engine), 1};
      frame.points.push_back(p);
    }
    span.frames.push_back(frame);
  }
  for (int i = 0; i < 800; ++i) {
    ImuSample sample;
    sample.t_ns = 5'000'000LL * i;
    sample.gyro = 1e-3 * Eigen::Vector3d(std::sin(12.9898 * i), std::sin(78.233 * i), std::sin(37.719 * i));
    span.imu.push_back(sample);
  }
  return span;
}

TEST(ClockOffset, NothingIsSaidWithoutRotationOrWithoutData) {
  const Rig rig = plainRig();
  EXPECT_FALSE(findClockOffset({}, {}, rig).determined);
  for (const double step_m : {0.02, 0.0})
    for (const double noise_px : {0.0, 0.05, 0.5}) {
      const Span span = sliding(step_m, noise_px);
      EXPECT_FALSE(findClockOffset(span.frames, span.imu, rig).determined) << step_m << " m, " << noise_px << " px";
    }
}

}  // namespace
}  // namespace lintel
