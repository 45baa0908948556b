// SPDX-License-Identifier: BSD-3-Clause
#include "RunCheck.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "lintel/geometry/Rotation.h"
#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/FigureTrajectory.h"
#include "lintel/simulation/TrackSimulation.h"

namespace lintel {
namespace {

Rig givenRig() {
  Rig rig;
  rig.camera.fx = rig.camera.fy = 458;
  rig.camera.lens[0] = -0.28;
  return rig;
}

/// `frames` at 10 Hz; the estimate gains speed steadily, the accelerometer shows `gravity`. Every frame becomes a
/// keyframe, each second one moved by `jump_m` against what the IMU says in one solve, and by `move_m` from one solve
/// to the next.
std::string verdictOf(double gravity, double acceleration, std::size_t resets = 0, double share_with_pose = 1,
                      const Rig& estimated = givenRig(), double jump_m = 0, int frames = 100,
                      const RefinementReport& refinement = {}, double move_m = 0) {
  RunCheck check{givenRig()};
  OdometryStatistics statistics;
  const auto image =
      std::make_shared<GrayImage>(GrayImage{64, 64, std::vector<std::uint8_t>(std::size_t{64} * 64, 100)});
  std::int64_t t_ns = 1'000'000'000;
  statistics.first_frame_ns = t_ns;
  statistics.first_start_s = 0;
  for (int frame = 0; frame < frames; ++frame) {
    TrackedFrame tracked;
    tracked.step.frame.image = image;
    ImuBatch& imu = tracked.step.imu;
    for (int i = 0; i <= 20; ++i) {
      ImuSample sample;
      sample.t_ns = t_ns + std::int64_t{5'000'000} * i;
      sample.accel.z() = gravity + 0.02 * std::sin(97.0 * (i + 20 * frame));
      imu.push_back(sample);
    }
    t_ns += 100'000'000;
    WindowUpdate update;
    update.t_ns = t_ns;
    update.status = EstimatorStatus::kTracking;
    update.v_w_b.x() = acceleration * 0.1 * frame;
    RetiredKeyframe keyframe;
    keyframe.T_w_b.p.y() = frame % 2 ? jump_m + move_m : 0;
    keyframe.next.emplace().T_w_b.p.y() = frame % 2 ? move_m : jump_m;
    auto integrated = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
    integrated->append(imu);
    keyframe.imu = integrated;
    if (gravity > 9.7) update.keyframes.push_back(keyframe);
    check.add(tracked, update);
    ++statistics.frames;
  }
  statistics.last_frame_ns = t_ns;
  statistics.resets = resets;
  statistics.frames_with_pose = static_cast<std::size_t>(share_with_pose * frames);
  return check.verdict(statistics, estimated, refinement);
}

TEST(RunCheck, AGoodRunHasNoVerdict) {
  EXPECT_EQ(verdictOf(9.81, 0), "");
  EXPECT_EQ(verdictOf(9.6, 1), "");
  EXPECT_EQ(verdictOf(9.81, 0, 1, 0.9), "");
}

TEST(RunCheck, AWrongGravityIsNamedFirst) {
  EXPECT_NE(verdictOf(1, 40).find("in g"), std::string::npos) << verdictOf(1, 40);
  EXPECT_NE(verdictOf(0.01, 40).find("gravity has been taken out"), std::string::npos) << verdictOf(0.01, 40);
}

/// A run of 100 keyframes at 10 Hz, without refinement: sample `i` of the 21 before a keyframe, and its state.
std::string verdictOfKeyframes(const std::function<ImuSample(int i)>& sample,
                               const std::function<void(double t_s, RetiredKeyframe&)>& place) {
  RunCheck check{givenRig()};
  OdometryStatistics statistics;
  const auto image =
      std::make_shared<GrayImage>(GrayImage{64, 64, std::vector<std::uint8_t>(std::size_t{64} * 64, 100)});
  for (int frame = 1; frame <= 100; ++frame) {
    TrackedFrame tracked;
    tracked.step.frame.image = image;
    WindowUpdate update;
    update.t_ns = std::int64_t{100'000'000} * frame;
    update.status = EstimatorStatus::kTracking;
    for (int i = 0; i <= 20; ++i) {
      tracked.step.imu.push_back(sample(i));
      tracked.step.imu.back().t_ns = update.t_ns - std::int64_t{5'000'000} * (20 - i);
    }
    auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
    imu->append(tracked.step.imu);
    RetiredKeyframe keyframe;
    keyframe.imu = imu;
    place(0.1 * frame, keyframe);
    update.v_w_b = keyframe.v_w_b;
    update.keyframes.push_back(keyframe);
    check.add(tracked, update);
    ++statistics.frames;
  }
  statistics.first_start_s = 0;
  statistics.last_frame_ns = 10'000'000'000;
  statistics.frames_with_pose = statistics.frames;
  return check.verdict(statistics, givenRig());
}

/// The estimate gains 5 m/s a second; `shown`: the accelerometer says so, too.
std::string verdictOfFastRun(bool shown, double acceleration = 5) {
  const auto sample = [&](int i) {
    const double shake = std::sin(97.0 * i);
    return ImuSample{0, {0.001 * shake, 0, 0}, {shown ? acceleration : 0, 0, 9.81 + 0.02 * shake}};
  };
  return verdictOfKeyframes(sample, [&](double t_s, RetiredKeyframe& keyframe) {
    keyframe.T_w_b.p.x() = 0.5 * acceleration * t_s * t_s;
    keyframe.v_w_b.x() = acceleration * t_s;
  });
}

TEST(RunCheck, ADivergedRunIsNoGoodOne) {
  EXPECT_NE(verdictOfFastRun(false).find("diverged"), std::string::npos) << verdictOfFastRun(false);
  EXPECT_NE(verdictOf(9.81, std::nan("")), "");
}

TEST(RunCheck, AFastVehicleIsBelievedWhereTheRefinementConfirmsIt) {
  RefinementReport refinement;
  refinement.rounds = 3, refinement.accepted = true, refinement.imu_after = 0.4;
  const auto verdict = [&](double acceleration) {
    return verdictOf(9.81, acceleration, 0, 1, givenRig(), 0, 100, refinement);
  };
  EXPECT_EQ(verdict(8), "") << "a car that brakes";
  EXPECT_NE(verdict(25).find("diverged"), std::string::npos);
  EXPECT_NE(verdict(std::nan("")), "");
  refinement.imu_after = 1.5;
  EXPECT_NE(verdict(8).find("diverged"), std::string::npos) << "the IMU contradicts it";
}

TEST(RunCheck, AFastVehicleIsBelievedWhereTheImuConfirmsIt) {
  EXPECT_EQ(verdictOfFastRun(true), "");
  EXPECT_NE(verdictOfFastRun(true, 25), "") << "nothing that one can drive";
}

TEST(RunCheck, AFailureWithoutDataIsNoDivergence) {
  for (const Failure failure : {Failure::kInterrupted, Failure::kWrongStart, Failure::kDiverged}) {
    RunCheck check{givenRig()};
    TrackedFrame tracked;
    tracked.step.frame.image =
        std::make_shared<GrayImage>(GrayImage{64, 64, std::vector<std::uint8_t>(std::size_t{64} * 64, 100)});
    WindowUpdate update;
    check.add(tracked, update);
    update.t_ns = 2'500'000'000;
    update.status = EstimatorStatus::kLost;
    update.failure = failure;
    update.reason = "the accelerometer bias is implausible";
    check.add(tracked, update);
    OdometryStatistics statistics;
    statistics.frames = statistics.frames_with_pose = 100;
    statistics.last_frame_ns = 5'000'000'000;
    const std::string verdict = check.verdict(statistics, givenRig());
    const bool said = verdict.find("diverged at 2.5 s: the accelerometer bias is implausible") != std::string::npos;
    EXPECT_EQ(said, failure == Failure::kDiverged) << verdict;
  }
}

/// A body at rest whose accelerometer shows along y some of what is along z; `known`: the estimate takes it out.
std::string verdictWithWrongAxes(bool known) {
  const auto sample = [](int) { return ImuSample{0, {0, 0, 0}, {0, 0.4, 9.8}}; };
  return verdictOfKeyframes(sample, [&](double, RetiredKeyframe& keyframe) {
    if (known) keyframe.axes.A(1, 2) = -0.4 / 9.8;
    keyframe.T_w_b.p.x() = 0.001;
  });
}

TEST(RunCheck, AxesThatTheEstimateKnowsAreNoContradiction) {
  EXPECT_NE(verdictWithWrongAxes(false).find("contradict"), std::string::npos) << verdictWithWrongAxes(false);
  EXPECT_EQ(verdictWithWrongAxes(true), "");
}

TEST(RunCheck, ACalibrationThatTheEstimateLeft) {
  Rig estimated = givenRig();
  estimated.camera.fx = estimated.camera.fy = 458 * 1.02;  // a roughly known one
  estimated.camera.lens[0] = 0.02;                         // the distortion is found from none given
  EXPECT_EQ(verdictOf(9.81, 0, 0, 1, estimated), "");
  estimated.camera.fx = estimated.camera.fy = 458 * 0.88;
  EXPECT_NE(verdictOf(9.81, 0, 0, 1, estimated).find("focal length -12 %"), std::string::npos);
  estimated = givenRig();
  estimated.T_b_c.p.y() = 0.3;
  EXPECT_NE(verdictOf(9.81, 0, 0, 1, estimated).find("moved by 30 cm"), std::string::npos);
  estimated = givenRig();
  estimated.camera.cx += 30;  // the middle of the image, given for a centre that nobody measured
  EXPECT_EQ(verdictOf(9.81, 0, 0, 1, estimated), "");
  estimated.camera.cy -= 52;
  EXPECT_NE(verdictOf(9.81, 0, 0, 1, estimated).find("centre moved by 60 px"), std::string::npos);
}

TEST(RunCheck, ImagesThatContradictTheImu) {
  EXPECT_EQ(verdictOf(9.81, 0, 0, 1, givenRig(), 5e-5), "");
  const std::string accel = verdictOf(9.81, 0, 0, 1, givenRig(), 2e-4);
  EXPECT_NE(accel.find("images and accelerometer contradict each other"), std::string::npos) << accel;
  EXPECT_NE(verdictOf(9.81, 0, 0, 1, givenRig(), 0.1).find("images and IMU contradict each other"), std::string::npos);
  EXPECT_EQ(verdictOf(9.81, 0, 0, 1, givenRig(), 0.1, 30), "") << "in the first seconds nothing has settled";
}

TEST(RunCheck, EstimatesThatMoveFromSolveToSolveAreNoContradiction) {
  EXPECT_EQ(verdictOf(9.81, 0, 0, 1, givenRig(), 0, 100, {}, 2e-4), "")
      << "far away from what it sees, a good IMU knows the way between keyframes better than images know each place";
}

TEST(RunCheck, ARefinementThatImagesAndImuAgreeWithExcusesTheWindow) {
  RefinementReport refinement;
  refinement.imu_after = 0.4;
  const auto verdict = [&](double jump_m) { return verdictOf(9.81, 0, 0, 1, givenRig(), jump_m, 100, refinement); };
  EXPECT_NE(verdict(2e-4), "") << "not accepted";
  refinement.accepted = true;
  EXPECT_EQ(verdict(2e-4), "") << "the calibration was found late";
  refinement.imu_after = 1.5;
  EXPECT_NE(verdict(2e-4).find("images and accelerometer contradict each other"), std::string::npos);
  EXPECT_EQ(verdict(5e-5), "") << "the window's fit";
  refinement.imu_after = 0.4;
  EXPECT_NE(verdict(0.1).find("images and IMU contradict each other"), std::string::npos);
}

/// A robot without a start that drives circles, whose gyroscope has a bias of 5 degrees a second.
double axesMisfitOfCircles(const Eigen::Vector3d& known_bias) {
  const Eigen::Vector3d bias(0.06, 0.02, 0.07);
  RunCheck check{givenRig(), 0, known_bias};
  for (int frame = 0; frame < 300; ++frame) {
    TrackedFrame tracked;
    tracked.step.frame.image =
        std::make_shared<GrayImage>(GrayImage{64, 64, std::vector<std::uint8_t>(std::size_t{64} * 64, 100)});
    for (int i = 0; i <= 20; ++i)
      tracked.step.imu.push_back(
          {std::llround(1e9 * (0.1 * frame + 0.005 * i)), Eigen::Vector3d(0, 0, 0.35) + bias, {0, 0.25, 9.81}});
    check.add(tracked, {});
  }
  return check.evidence().at("accelerometer_axes_misfit");
}

TEST(RunCheck, TheGyroscopesBiasIsNoTurnOfGravity) {
  EXPECT_GT(axesMisfitOfCircles({0, 0, 0}), 1.2) << "mixed up axes would fit better";
  EXPECT_EQ(axesMisfitOfCircles({0.06, 0.02, 0.07}), 1);
}

/// Of a run whose gyroscope and accelerometer are right, and that found poses for a share of its frames, as it waited
/// for `wait`; turns about the images' axes look larger by `gain`.
std::string verdictOfTurns(const std::string& wait, double share_with_pose = 0, double gain = 1) {
  TrackSimulationParams tracks;
  tracks.duration_s = 12;
  const SimulatedTracks flight = simulateTracks(FigureTrajectory(), eurocRig(), ImuSimulatorParams{}, tracks);
  std::vector<std::uint8_t> pixels;
  for (int k = 0; k < 64 * 64; ++k) pixels.push_back(static_cast<std::uint8_t>(37 * k % 251));
  RunCheck check{eurocRig()};
  OdometryStatistics statistics;
  std::optional<Eigen::Quaterniond> before;
  std::int64_t from_ns = 0;
  for (const SimulatedFrame& frame : flight.frames) {
    TrackedFrame tracked;
    std::rotate(pixels.begin(), pixels.begin() + 5, pixels.end());
    tracked.step.frame.image = std::make_shared<GrayImage>(GrayImage{64, 64, pixels});
    tracked.step.frame.t_ns = frame.tracks.t_ns;
    tracked.step.imu = frame.imu;
    const Eigen::Quaterniond R_w_c = frame.truth.state.T_w_b.q * eurocRig().T_b_c.q;
    if (before)
      tracked.turn = {from_ns, frame.tracks.t_ns,
                      Eigen::Vector3d(gain, gain, 1).asDiagonal() * logRotation(before->conjugate() * R_w_c),
                      Eigen::Vector3d::Constant(0.001)};
    before = R_w_c, from_ns = frame.tracks.t_ns;
    check.add(tracked, {});
    ++statistics.frames;
  }
  statistics.main_wait = wait;
  statistics.frames_with_pose = static_cast<std::size_t>(share_with_pose * static_cast<double>(statistics.frames));
  return check.verdict(statistics, eurocRig());
}

TEST(RunCheck, WhereOnlyTheScaleIsMissingTheMotionIsNamedBeforeTheAccelerometer) {
  EXPECT_NE(verdictOfTurns(kScaleUnknown).find("may accelerate too little"), std::string::npos);
  EXPECT_NE(verdictOfTurns("too few points agree with the motion").find("so look at the accelerometer"),
            std::string::npos);
}

TEST(RunCheck, WhereFewFramesHaveAPoseASmallerContradictionCounts) {
  EXPECT_EQ(verdictOfTurns("", 0.1), "") << "a long rest";
  EXPECT_EQ(verdictOfTurns("", 0.9, 1.4), "") << "the window finds the focal length";
  const std::string verdict = verdictOfTurns("", 0.1, 1.4);
  EXPECT_NE(verdict.find("poses for only 10 % of the frames; the focal length"), std::string::npos) << verdict;
}

/// Half a minute of turning about x; each second keyframe jumps.
std::string verdictWithAccelerometer(bool swapped, double jump_m, const RefinementReport& refinement = {}) {
  RunCheck check{givenRig()};
  OdometryStatistics statistics;
  std::vector<std::uint8_t> pixels;
  pixels.reserve(std::size_t{64} * 64);
  for (int k = 0; k < 64 * 64; ++k) pixels.push_back(static_cast<std::uint8_t>(37 * k % 251));
  for (int frame = 0; frame < 300; ++frame) {
    TrackedFrame tracked;
    std::rotate(pixels.begin(), pixels.begin() + 5, pixels.end());
    tracked.step.frame.image = std::make_shared<GrayImage>(GrayImage{64, 64, pixels});
    for (int i = 0; i <= 20; ++i) {
      const double t_s = 0.1 * frame + 0.005 * i, angle = 1.2 * std::sin(0.7 * t_s);
      const Eigen::Vector3d g(0, 9.81 * std::sin(angle), 9.81 * std::cos(angle));
      tracked.step.imu.push_back({std::llround(1e9 * t_s),
                                  {0.84 * std::cos(0.7 * t_s), 0, 0},
                                  swapped ? Eigen::Vector3d(g.x(), g.z(), g.y()) : g});
    }
    WindowUpdate update;
    update.t_ns = tracked.step.imu.back().t_ns;
    update.status = EstimatorStatus::kTracking;
    RetiredKeyframe keyframe;
    keyframe.T_w_b.p.y() = frame % 2 ? jump_m : 0;
    ImuBatch level;  // what the estimate makes of it
    for (const ImuSample& sample : tracked.step.imu) level.push_back({sample.t_ns, {0, 0, 0}, {0, 0, 9.81}});
    auto integrated = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
    integrated->append(level);
    keyframe.imu = integrated;
    update.keyframes.push_back(keyframe);
    check.add(tracked, update);
    ++statistics.frames;
  }
  statistics.last_frame_ns = 30'000'000'000;
  statistics.first_start_s = 0;
  statistics.frames_with_pose = 300;
  return check.verdict(statistics, givenRig(), refinement);
}

TEST(RunCheck, InterchangedAxesOfTheAccelerometerThatTheEstimateCouldNearlyFollow) {
  constexpr double kJump_m = 0.00022;
  EXPECT_EQ(verdictWithAccelerometer(false, kJump_m).find("columns"), std::string::npos);
  const std::string verdict = verdictWithAccelerometer(true, kJump_m);
  EXPECT_NE(verdict.find("columns"), std::string::npos) << verdict;
  RefinementReport refinement;
  refinement.imu_after = 0.2;
  EXPECT_NE(verdictWithAccelerometer(true, kJump_m, refinement), "") << "not accepted";
  refinement.accepted = true;
  EXPECT_EQ(verdictWithAccelerometer(true, kJump_m, refinement), "") << "a drone far above the ground";
  refinement.imu_after = 0.8;
  EXPECT_NE(verdictWithAccelerometer(true, kJump_m, refinement), "") << "could be followed by the refinement, too";
}

TEST(RunCheck, StartsThatDoNotLast) { EXPECT_NE(verdictOf(9.81, 0, 2, 0.2).find("did not last"), std::string::npos); }

}  // namespace
}  // namespace lintel
