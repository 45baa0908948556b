// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/Estimator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "EstimatorRuns.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using namespace test;

/// The flight as a front end sees it that was told another rig.
TrackedFlight toldAnotherRig(TrackedFlight flight, const Rig& told) {
  for (SimulatedFrame& frame : flight.sim.frames) {
    for (PointObservation& o : frame.tracks.points) o.ray = told.camera.ray(o.px);
    for (LineObservation& o : frame.tracks.lines) {
      o.start = told.camera.ray(o.start_px);
      o.end = told.camera.ray(o.end_px);
    }
  }
  flight.rig = told;
  return flight;
}

TEST(EstimatorCalibration, FindsTheCalibrationFromARoughOne) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(10, 0.5));
  Rig rough = flight.rig;
  rough.camera.fx *= 1.02;
  rough.camera.fy *= 1.02;
  rough.camera.lens = {};
  rough.T_b_c.q = rough.T_b_c.q * expRotation(Eigen::Vector3d(0.03, -0.03, 0.03));
  rough.T_b_c.p += Eigen::Vector3d(0.02, -0.01, 0.02);
  const TrackedFlight told = toldAnotherRig(flight, rough);
  Estimator estimator(rough, {});
  std::vector<WindowUpdate> updates;
  for (const SimulatedFrame& frame : told.sim.frames) updates.push_back(estimator.process(frame.tracks, frame.imu));
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_LT(positionError(updates, flight), 0.1);
  const CalibrationEstimate found = estimator.calibration();
  EXPECT_NEAR(found.camera.meanFocal(), flight.rig.camera.meanFocal(), 2);
  EXPECT_NEAR(found.camera.lens[0], flight.rig.camera.lens[0], 0.01);
  EXPECT_LT(found.T_b_c.q.angularDistance(flight.rig.T_b_c.q), 0.005);
}

/// The flight with an IMU whose samples f and w show the specific force f + A f and the rate w + G w.
TrackedFlight misaligned(TrackedFlight flight, const ImuAxes& axes) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (SimulatedFrame& frame : flight.sim.frames)
    for (ImuSample& sample : frame.imu) {
      sample.accel = (I + axes.A).inverse() * sample.accel;
      sample.gyro = (I + axes.G).inverse() * sample.gyro;
    }
  return flight;
}

/// Of a telephone.
ImuAxes roughAxes() {
  ImuAxes axes;
  axes.A << 0.004, -0.02, 0, 0.05, -0.006, -0.03, -0.01, 0.02, 0.01;
  axes.G << 0.015, 0.01, 0, 0.01, -0.02, -0.01, 0, -0.01, 0.01;
  return axes;
}

TEST(EstimatorCalibration, FindsWhatTheAxesOfTheImuAreWrongBy) {
  FigureParams tilting;
  tilting.rotation = 2;
  tilting.seed = 1;
  const TrackedFlight right = fly(ImuSimulatorParams{}, tracksFor(20, 0.3), FigureTrajectory(tilting)),
                      wrong = misaligned(right, roughAxes());
  EstimatorParams held;
  held.calibration.refine_axes = false;
  EXPECT_LT(positionError(run(wrong), right), 0.6 * positionError(run(wrong, held), right));
  Estimator estimator(wrong.rig, {});
  for (const SimulatedFrame& frame : wrong.sim.frames) estimator.process(frame.tracks, frame.imu);
  const CalibrationEstimate found = estimator.calibration();
  const ImuAxes axes = roughAxes();
  EXPECT_NEAR(found.accelerometer_axes(0, 1), axes.A(0, 1), 0.004);
  EXPECT_NEAR(found.accelerometer_axes(1, 2), axes.A(1, 2), 0.005);
  EXPECT_LT((found.accelerometer_axes - axes.A).cwiseAbs().maxCoeff(), 0.4 * 0.05) << found.accelerometer_axes;
  EXPECT_LT((found.gyroscope_axes - axes.G).cwiseAbs().maxCoeff(), 0.25 * 0.02) << found.gyroscope_axes;
}

/// The flight with stamps of the images that are off by `sigma_s` each; the samples are those between the stamps.
TrackedFlight withJitter(TrackedFlight flight, double sigma_s, unsigned seed) {
  ImuBatch all;
  for (const SimulatedFrame& frame : flight.sim.frames)
    for (const ImuSample& sample : frame.imu)
      if (all.empty() || sample.t_ns > all.back().t_ns) all.push_back(sample);
  const auto at = [&](std::int64_t t_ns) {
    const auto after = std::lower_bound(all.begin() + 1, all.end() - 1, t_ns,
                                        [](const ImuSample& s, std::int64_t t) { return s.t_ns < t; });
    const ImuSample &a = after[-1], &b = *after;
    const double share = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    return ImuSample{t_ns, a.gyro + share * (b.gyro - a.gyro), a.accel + share * (b.accel - a.accel)};
  };
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, sigma_s);
  std::int64_t before_ns = all.front().t_ns;
  for (SimulatedFrame& frame : flight.sim.frames) {
    const std::int64_t t_ns = frame.tracks.t_ns += std::llround(1e9 * std::clamp(normal(random), -0.02, 0.02));
    frame.imu = {at(before_ns)};
    for (const ImuSample& sample : all)
      if (sample.t_ns > before_ns && sample.t_ns < t_ns) frame.imu.push_back(sample);
    frame.imu.push_back(at(t_ns));
    before_ns = t_ns;
  }
  return flight;
}

TEST(EstimatorCalibration, StampsThatAreOffEachByItsOwnAmountAreFoundAndCounted) {
  const double sigma_s = 0.002;
  const TrackedFlight exact = fly(ImuSimulatorParams{}, tracksFor(10, 0.3));
  EstimatorParams ignoring;
  ignoring.calibration.find_stamp_jitter = false;
  double log_ratio = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const TrackedFlight flight = withJitter(exact, sigma_s, seed);
    Estimator estimator(flight.rig, {});
    std::vector<WindowUpdate> updates;
    for (const SimulatedFrame& frame : flight.sim.frames) updates.push_back(estimator.process(frame.tracks, frame.imu));
    EXPECT_GT(posesOf(updates), 160);
    EXPECT_NEAR(estimator.calibration().stamp_jitter_s, sigma_s, 0.5 * sigma_s);
    log_ratio += std::log(positionError(updates, flight) / positionError(run(flight, ignoring), flight)) / 3;
  }
  EXPECT_LT(std::exp(log_ratio), 0.9);
}

TEST(EstimatorCalibration, StampsThatAreRightHaveNoJitter) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(10, 0.5));
  Estimator estimator(flight.rig, {});
  for (const SimulatedFrame& frame : flight.sim.frames) estimator.process(frame.tracks, frame.imu);
  EXPECT_EQ(estimator.calibration().stamp_jitter_s, 0);
}

TEST(EstimatorCalibration, OnlyAfterAStartInMotionTheAccelerometerHasCorrelatedNoise) {
  const auto noiseAfter = [](double rest_s) {
    const DelayedStart flown(std::make_shared<FigureTrajectory>(), rest_s);
    TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(rest_s + 5, 0.2), flown);
    for (std::size_t k = static_cast<std::size_t>(20 * rest_s); k < flight.sim.frames.size(); ++k)
      for (std::size_t i = 0; i < flight.sim.frames[k].imu.size(); ++i)  // its motors run
        flight.sim.frames[k].imu[i].accel.x() += i % 2 == 0 ? 2 : -2;
    std::set<bool> has_some;
    for (const WindowUpdate& update : run(flight))
      for (const RetiredKeyframe& keyframe : update.keyframes)
        if (keyframe.imu) has_some.insert(keyframe.imu->noise().accel_correlated > 0);
    return has_some;
  };
  EXPECT_EQ(noiseAfter(0), std::set<bool>{true});
  EXPECT_EQ(noiseAfter(3), std::set<bool>{false});
}

/// Another motion, later.
class Later : public Trajectory {
 public:
  Later(std::shared_ptr<const Trajectory> motion, double by_s) : motion_(std::move(motion)), by_s_(by_s) {}
  KinematicState at(double t_s) const override { return motion_->at(t_s + by_s_); }

 private:
  std::shared_ptr<const Trajectory> motion_;
  double by_s_;
};

TEST(EstimatorCalibration, MotorsDoNotShrinkTheTimeOffset) {
  // a rate that is one sample's is wrong by its vibration, and the slope of a line through wrong abscissas is too small
  constexpr double kOffset_s = 0.002;
  const auto motion = std::make_shared<FigureTrajectory>();
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(9, 0.1), Later(motion, kOffset_s));
  const TrackedFlight on_time = fly(ImuSimulatorParams{}, tracksFor(9, 0.1), *motion);
  std::mt19937_64 random(5);
  std::normal_distribution<double> shaking(0, 0.15);
  Eigen::Vector3d angle = Eigen::Vector3d::Zero(), vibration = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k) {
    ImuBatch& imu = flight.sim.frames[k].imu = on_time.sim.frames[k].imu;
    for (std::size_t i = 0; i < imu.size(); ++i) {
      if (i > 0 || k == 0) {  // a batch begins with the sample that ends the one before
        const Eigen::Vector3d former = angle;
        angle = Eigen::Vector3d(shaking(random), shaking(random), shaking(random));
        vibration = angle - former;  // it does not turn the body
      }
      imu[i].gyro += vibration;
    }
  }
  Estimator estimator(flight.rig, {});
  for (const SimulatedFrame& frame : flight.sim.frames) estimator.process(frame.tracks, frame.imu);
  EXPECT_NEAR(estimator.calibration().time_offset_s, kOffset_s, 0.15 * kOffset_s);
}

TEST(EstimatorCalibration, PosesOfImagesAreThoseWhenTheyWereTaken) {
  constexpr double kOffset_s = 0.008;
  const auto motion = std::make_shared<FigureTrajectory>();
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(9, 0.1), Later(motion, kOffset_s));
  const TrackedFlight on_time = fly(ImuSimulatorParams{}, tracksFor(9, 0.1), *motion);
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k) flight.sim.frames[k].imu = on_time.sim.frames[k].imu;
  EstimatorParams params;
  params.calibration.time_offset_sigma_s = 0.005;
  std::vector<WindowUpdate> updates = run(flight, params);
  const double of_states = positionError(updates, on_time);
  for (WindowUpdate& update : updates) update.T_w_b = update.T_w_b_image;
  EXPECT_LT(positionError(updates, flight), 1.1 * of_states) << "truth at the images' own times";
  EXPECT_GT(positionError(updates, on_time), 1.5 * of_states) << "truth at their stamps";
}

}  // namespace
}  // namespace lintel
