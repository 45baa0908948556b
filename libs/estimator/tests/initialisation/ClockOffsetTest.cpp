// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/ClockOffset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "TestWindow.h"
#include "initialisation/ClockFit.h"
#include "lintel/geometry/Rotation.h"

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

/// What it turns depends on how the body turns meanwhile: taken as a constant it leaves residuals, which looked like 15
/// ms on a hand.
TEST(ClockOffset, ALargeGyroBiasLeavesNoResidual) {
  const TrackedFlight f = turningFlight(0.3, 0);
  ASSERT_GT(f.truth(0).bias_gyro.norm(), 0.3);
  const Span span = spanOf(f, 0);
  const ClockOffset found = findClockOffset(span.frames, span.imu, f.rig);
  EXPECT_TRUE(found.determined);
  EXPECT_NEAR(found.offset_s, 0, 5e-4);
  EXPECT_LT(found.rms_px, 0.01);
  EXPECT_LT((found.bias_gyro - f.truth(0).bias_gyro).norm(), 2e-3);
}

/// Else the costs along the range, and with them the standard deviation, would show the order of the search.
TEST(ClockOffset, TheCostOfAnOffsetIsTheSameFromWhereverTheSearchComes) {
  const TrackedFlight f = turningFlight(0.05, 0.5);
  const Span span = spanOf(f, 0);
  const std::vector<TimedPair> pairs = timedPairs(span.frames, GyroPath(span.imu), f.rig);
  const auto costAt = [&](const std::vector<double>& offsets_s) {
    ClockFit fit(pairs, span.imu, 0, 2 / f.rig.camera.meanFocal());
    EpipolarSystem system;
    for (const double offset_s : offsets_s) system = fit.at(offset_s);
    return system.cost / fit.variance(system);
  };
  constexpr double kFarBelowOne = 0.02;  // likelihoods of offsets differ by one variance of the cost and more
  const double cost = costAt({0.06});
  EXPECT_NEAR(costAt({-0.1, 0.06}), cost, kFarBelowOne);
  EXPECT_NEAR(costAt({0.1, 0.06}), cost, kFarBelowOne);
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

/// The costs of neighbouring offsets differ by noise, and a parabola fits a narrow minimum into a cost that is flat
/// over the whole range.
TEST(ClockOffset, SlowTurnsWithNoisyImagesAndGyroscopeShowNone) {
  FigureParams gentle;
  gentle.shake = 0;
  gentle.period_s = 30;
  gentle.turn_rate_rad_s = 0.05;
  gentle.sweep_rad = 0.02;
  TrackSimulationParams tracks;
  tracks.duration_s = 4;
  tracks.point_noise_px = 3;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    ImuSimulatorParams imu;
    imu.noise_scale = 5;
    imu.seed = gentle.seed = seed;
    const TrackedFlight f = fly(imu, tracks, FigureTrajectory(gentle));
    const Span span = spanOf(f, 0);
    const ClockOffset found = findClockOffset(span.frames, span.imu, f.rig);
    EXPECT_FALSE(found.determined) << found.offset_s << " +- " << found.sigma_s << " s, seed " << seed;
  }
}

/// A rolling shutter that a hand turns and moves among points; an image with stamp t shows, in its middle row, the
/// world at t + offset of the IMU's clock.
class RollingSpan {
 public:
  RollingSpan(double readout_s, double offset_s, double noise_px) : readout_s_(readout_s), noise_(0, noise_px) {
    rig.T_b_c = {expRotation({0.3, -0.2, 1.5}), {0.05, -0.02, 0.1}};
    for (int i = 0; i < 80; ++i) frame(1 + 0.05 * i, offset_s);
    constexpr double kHalf_s = 1e-3;
    for (int i = 0; i < 1200; ++i) {
      const double t_s = 0.005 * i;
      ImuSample sample;
      sample.t_ns = std::llround(1e9 * t_s);
      sample.gyro = logRotation(T_w_b(t_s - kHalf_s).q.conjugate() * T_w_b(t_s + kHalf_s).q) / (2 * kHalf_s) + kBias;
      span.imu.push_back(sample);
    }
  }

  Rig rig = plainRig();
  Span span;

 private:
  static Pose T_w_b(double t) {
    return {expRotation({0.12 * std::sin(3.1 * t), 0.1 * std::sin(4.3 * t + 1), 0.15 * std::sin(5.3 * t)}),
            {0.2 * std::sin(1.1 * t), 0.15 * std::sin(1.7 * t), 0.1 * t}};
  }

  Eigen::Vector2d seenAt(const Eigen::Vector3d& p_w, double t_s) const {
    return rig.camera.project((T_w_b(t_s) * rig.T_b_c).inverse() * p_w);
  }

  void frame(double stamp_s, double offset_s) {
    FrameTracks frame;
    frame.t_ns = std::llround(1e9 * stamp_s);
    const Camera& camera = rig.camera;
    for (TrackId id = 0; id < 60; ++id) {
      const Eigen::Vector3d p_c(0.6 * (static_cast<double>(id % 10) - 4.5), 0.6 * (static_cast<double>(id / 10) - 2.5),
                                3.0 + static_cast<double>(id % 7));
      const Eigen::Vector3d p_w = rig.T_b_c.q * p_c;
      Eigen::Vector2d px = seenAt(p_w, stamp_s + offset_s);
      for (int i = 0; i < 10; ++i)
        px = seenAt(p_w, stamp_s + offset_s + (px.y() / (camera.height - 1) - 0.5) * readout_s_);
      px += Eigen::Vector2d(noise_(engine_), noise_(engine_));
      PointObservation p;
      p.id = id;
      p.px = px;
      p.ray = camera.ray(px);
      frame.points.push_back(p);
    }
    span.frames.push_back(frame);
  }

  static inline const Eigen::Vector3d kBias{0.02, -0.01, 0.03};
  double readout_s_;
  std::mt19937_64 engine_{7};
  std::normal_distribution<double> noise_;
};

TEST(ClockOffset, TheReadoutOfARollingShutterIsFoundWithIt) {
  for (const double readout_s : {0.025, -0.015})
    for (const double offset_s : {-0.05, 0.0}) {
      const RollingSpan rolling(readout_s, offset_s, 0.4);
      const ClockOffset found = findClockOffset(rolling.span.frames, rolling.span.imu, rolling.rig);
      ASSERT_TRUE(found.determined);
      EXPECT_NEAR(found.offset_s, offset_s, 0.002) << readout_s;
      EXPECT_NEAR(found.readout_s, readout_s, 0.003) << offset_s;
      EXPECT_GT(found.readout_sigma_s, 0);
      EXPECT_LT(found.readout_sigma_s, 0.01);
    }
}

/// With much noise another readout is as likely as before: window and refinement see it when it is not held.
TEST(ClockOffset, AReadoutThatIsHardlySeenStaysOpen) {
  const RollingSpan rolling(0.01, 0, 3);
  const ClockOffset found = findClockOffset(rolling.span.frames, rolling.span.imu, rolling.rig);
  ASSERT_TRUE(found.determined);
  EXPECT_EQ(found.readout_s, 0);
  EXPECT_GT(found.readout_sigma_s, 0.002);
}

TEST(ClockOffset, AGivenReadoutIsKept) {
  RollingSpan rolling(0.025, -0.05, 0.4);
  rolling.rig.line_delay_s = 0.025 / rolling.rig.camera.height;
  const ClockOffset found = findClockOffset(rolling.span.frames, rolling.span.imu, rolling.rig);
  EXPECT_NEAR(found.offset_s, -0.05, 0.002);
  EXPECT_EQ(found.readout_s, rolling.rig.readout_s());
  EXPECT_EQ(found.readout_sigma_s, 0);
}

TEST(ClockOffset, AGlobalShutterKeepsItsRows) {
  const RollingSpan global(0, 0, 0.4);
  const ClockOffset found = findClockOffset(global.span.frames, global.span.imu, global.rig);
  EXPECT_NEAR(found.offset_s, 0, 0.002);
  EXPECT_EQ(found.readout_s, 0);
  EXPECT_EQ(found.readout_sigma_s, 0);
}

}  // namespace
}  // namespace lintel
