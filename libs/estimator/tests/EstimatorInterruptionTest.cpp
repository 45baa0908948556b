// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/Estimator.h"

#include <gmock/gmock.h>

#include <cmath>

#include "EstimatorRuns.h"
#include "lintel/geometry/Alignment.h"
#include "lintel/geometry/Frames.h"

namespace lintel {
namespace {

using namespace test;

TEST(EstimatorInterruption, AShortDropOutOfTheImuIsBridged) {
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t from = 60, to = 68;  // 0.4 s
  const ImuSample a = flight.sim.frames[from].imu.front(), b = flight.sim.frames[to - 1].imu.back();
  for (std::size_t k = from; k < to; ++k)
    for (ImuSample& sample : flight.sim.frames[k].imu) {
      const double s = static_cast<double>(sample.t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
      sample = {sample.t_ns, a.gyro + s * (b.gyro - a.gyro), a.accel + s * (b.accel - a.accel), true};
    }
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_LT(positionError(updates, flight), 0.05);
}

TEST(EstimatorInterruption, AnImuGapIsAFailureAndItStartsAgainWhereItWas) {
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t gap = 60;
  flight.sim.frames[gap].imu.clear();
  const auto updates = run(flight);
  ASSERT_TRUE(updates[gap - 1].hasPose());
  EXPECT_EQ(updates[gap].status, EstimatorStatus::kLost);
  EXPECT_EQ(updates[gap].reason, "the IMU has a gap");
  EXPECT_EQ(updates[gap].failure, Failure::kInterrupted);
  EXPECT_FALSE(updates[gap].keyframes.empty()) << "what was computed before is handed over";
  EXPECT_FALSE(updates[gap].points.empty());
  EXPECT_EQ(lostOf(updates), 1);
  std::size_t again = gap + 1;
  while (again < flight.sim.frames.size() && !updates[again].hasPose()) ++again;
  ASSERT_LT(again, gap + 55) << "starts again";
  EXPECT_NE(updates[gap + 5].reason, "");
  // the second start continues at the last pose: the first frame of its window lies there
  EXPECT_LT((updates[again].T_w_b.p - updates[gap - 1].T_w_b.p).norm(),
            (flight.truth(again).state.T_w_b.p - flight.truth(gap).state.T_w_b.p).norm() + 1.0);
  EXPECT_NEAR(updates[again].v_w_b.norm(), flight.truth(again).state.v_w_b.norm(), 0.2);
  expectEachIdOnce(updates);
}

TEST(EstimatorInterruption, StartsAtRestAndTakesOff) {
  const DelayedStart resting(std::make_shared<FigureTrajectory>(), 3);
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(7, 0.1), resting);
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  std::size_t first = 0;
  while (first < updates.size() && !updates[first].hasPose()) ++first;
  EXPECT_LE(first, 25u) << "a pose while it still rests";
  EXPECT_TRUE(updates[first + 4].at_rest || updates[first + 5].at_rest);
  EXPECT_LT(updates[40].v_w_b.norm(), 0.05);
  EXPECT_LT((updates[48].T_w_b.p - updates[first].T_w_b.p).norm(), 0.03) << "drift while it rests";
  EXPECT_LT(positionError(updates, flight), 0.05);
}

TEST(EstimatorInterruption, RestsWhileItsMotorsRunBeforeTakeOff) {
  const DelayedStart resting(std::make_shared<FigureTrajectory>(), 6);
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(9, 0.2), resting);
  constexpr std::size_t kMotorsOn = 40, kTakeOff = 115;  // 2 s, a little before 6 s
  for (std::size_t k = kMotorsOn; k < kTakeOff; ++k)
    for (std::size_t i = 0; i < flight.sim.frames[k].imu.size(); ++i) {
      ImuSample& sample = flight.sim.frames[k].imu[i];
      sample.accel += Eigen::Vector3d(0.05, -0.03, 0.02) + (i % 2 == 0 ? 1 : -1) * Eigen::Vector3d(0.8, 0.7, 1);
      sample.gyro += (i % 2 == 0 ? 0.06 : -0.06) * Eigen::Vector3d(1, -1, 0.5);
    }
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  ASSERT_TRUE(updates[kMotorsOn].hasPose());
  EXPECT_TRUE(updates[kTakeOff - 1].at_rest || updates[kTakeOff - 2].at_rest);
  for (std::size_t k = kMotorsOn; k < kTakeOff; ++k)
    ASSERT_LT((updates[k].T_w_b.p - updates[kMotorsOn].T_w_b.p).norm(), 0.02) << "drift, frame " << k;
}

/// Of a gentle motion fifteen frames in a row, one and a half seconds, do not show the scale. While it is waited for,
/// the buffer becomes longer by frames that are left out between others.
TEST(EstimatorInterruption, ABufferThatDoesNotShowTheScaleBecomesLonger) {
  FigureParams gentle;
  gentle.shake = 0;
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(8, 0.3), FigureTrajectory(gentle));
  EstimatorParams params = withoutCalibration();
  params.initializer.max_frames = 15;
  const auto updates = run(flight, params, false);
  ASSERT_GT(posesOf(updates), 60);
  EXPECT_EQ(lostOf(updates), 0);
  const auto [estimate, truth] = positionsOf(updates, flight);
  EXPECT_NEAR(alignPositions(AlignmentKind::kSim3, estimate, truth).scale, 1, 0.08);
}

/// Tracks that follow nothing in space fill the buffer for five seconds; then they are good.
TEST(EstimatorInterruption, AStartIsMadeOfTheNewestFramesWhereTheOldestAreOfNoUse) {
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(9, 0.3));
  constexpr std::size_t kGood = 100;
  for (std::size_t k = 0; k < kGood; ++k) {
    FrameTracks& tracks = flight.sim.frames[k].tracks;
    tracks.lines.clear();
    for (PointObservation& point : tracks.points) {
      const double turn = 2.4 * static_cast<double>(k + 7 * point.id);
      point.px += 40 * Eigen::Vector2d(std::cos(turn), std::sin(turn));
      point.ray = flight.rig.camera.ray(point.px);
      point.id += 1000000;
    }
  }
  EstimatorParams params = withoutCalibration();
  params.initializer.max_frames = 24;
  const auto updates = run(flight, params);
  std::size_t first = 0;
  while (first < updates.size() && !updates[first].hasPose()) ++first;
  EXPECT_GE(first, kGood);
  EXPECT_LT(first, kGood + 30);
  EXPECT_LT(positionError(updates, flight), 0.05);
}

TEST(EstimatorInterruption, PureRotationGivesNoPoseRatherThanAWrongOne) {
  FigureParams turning;
  turning.translation = 0;
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(3, 0.5), FigureTrajectory(turning));
  const auto updates = run(flight);
  EXPECT_EQ(posesOf(updates), 0);
  EXPECT_NE(updates[60].reason, "");
}

/// The flight with nothing to be seen in some frames.
TrackedFlight darkened(TrackedFlight flight, std::size_t from, std::size_t frames) {
  for (std::size_t k = from; k < from + frames; ++k) {
    flight.sim.frames[k].tracks.points.clear();
    flight.sim.frames[k].tracks.lines.clear();
  }
  return flight;
}

TEST(EstimatorInterruption, AFrameThatShowsNothingIsLeftToTheNextOne) {
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t every = static_cast<std::size_t>(EstimatorParams{}.every_nth_frame);
  const std::size_t step = 5 * every + 1;  // the one after a dark frame enters the window, and every n-th from it on
  for (std::size_t k = 60; k < flight.sim.frames.size(); k += step) flight = darkened(flight, k, 1);
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  for (std::size_t k = 60; k + 1 < updates.size(); k += step) {
    EXPECT_EQ(updates[k].status, EstimatorStatus::kPropagated) << k;
    EXPECT_EQ(updates[k + 1].status, EstimatorStatus::kTracking) << k;
  }
  EXPECT_LT(positionError(updates, flight), 0.03);
}

TEST(EstimatorInterruption, BlindnessIsBridgedForAWhileAndThenAFailure) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t dark = 60, waits = 10;  // half a second for an image that shows something
  EstimatorParams params;
  params.failure.max_blind_frames = 20;
  const auto moment = run(darkened(flight, dark, 6), params);
  EXPECT_EQ(lostOf(moment), 0);
  EXPECT_TRUE(moment[dark + 5].hasPose());
  const std::size_t frames = waits + 2 * static_cast<std::size_t>(params.failure.max_blind_frames) + 6;
  const auto longer = run(darkened(flight, dark, frames), params);
  ASSERT_GE(lostOf(longer), 1);
  for (const WindowUpdate& u : longer)
    if (u.status == EstimatorStatus::kLost) {
      EXPECT_NE(u.reason, "");
      break;
    }
}

TEST(EstimatorInterruption, FiveSecondsOfDarknessAreCarriedByTheImu) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(14, 0.3));
  const std::size_t dark = 120, light = dark + 100;
  const auto updates = run(darkened(flight, dark, light - dark));
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_FALSE(updates[dark - 20].blind);
  EXPECT_TRUE(updates[dark + 50].blind);
  EXPECT_FALSE(updates.end()[-4].blind);
  for (std::size_t k = dark; k < flight.sim.frames.size(); ++k) ASSERT_TRUE(updates[k].hasPose()) << k;
  EXPECT_LT(positionError(updates, flight), 0.1) << "one frame before and after";
}

/// The flight with an accelerometer that shows `share` of the motion in the first `frames`: gravity stays.
TrackedFlight withSlowStart(TrackedFlight flight, std::size_t frames, double share) {
  const Eigen::Vector3d up_w = -gravityW();
  for (std::size_t k = 1; k < frames; ++k) {
    const InertialTruth &a = flight.truth(k - 1), &b = flight.truth(k);
    for (ImuSample& sample : flight.sim.frames[k].imu) {
      const double s = static_cast<double>(sample.t_ns - flight.sim.frames[k - 1].tracks.t_ns) /
                       static_cast<double>(flight.sim.frames[k].tracks.t_ns - flight.sim.frames[k - 1].tracks.t_ns);
      const Eigen::Vector3d up_b = a.state.T_w_b.q.slerp(s, b.state.T_w_b.q).conjugate() * up_w;
      sample.accel = up_b + share * (sample.accel - up_b);
    }
  }
  return flight;
}

/// The trajectory that is left when what wrong starts gave is withdrawn.
std::vector<std::pair<std::int64_t, Pose>> trajectoryOf(const std::vector<WindowUpdate>& updates) {
  std::vector<std::pair<std::int64_t, Pose>> poses;
  std::size_t settled = 0;
  for (const WindowUpdate& u : updates) {
    for (const FramePose& frame : u.replaced) poses.emplace_back(frame.t_ns, frame.T_w_b);
    if (u.hasPose()) poses.emplace_back(u.t_ns, u.T_w_b);
    if (u.startWasWrong()) poses.resize(settled);
    if (u.status == EstimatorStatus::kLost) settled = poses.size();
  }
  return poses;
}

TEST(EstimatorInterruption, AWrongStartIsWithdrawnAndReplacedWithoutAGap) {
  const std::size_t wrong = 36;
  const TrackedFlight flight = withSlowStart(fly(ImuSimulatorParams{}, tracksFor(9, 0.3)), wrong, 3);
  const auto updates = run(flight);
  ASSERT_EQ(lostOf(updates), 1);
  std::size_t lost = 0, first = 0;
  while (!updates[first].hasPose()) ++first;
  while (updates[lost].status != EstimatorStatus::kLost) ++lost;
  EXPECT_LT(first, wrong);
  EXPECT_LE(lost, first + 60) << "while the start was on trial";
  EXPECT_TRUE(updates[lost].startWasWrong());
  EXPECT_EQ(updates[lost].reason.find("the start was wrong"), 0u) << updates[lost].reason;
  EXPECT_TRUE(updates[lost].keyframes.empty());
  EXPECT_TRUE(updates[lost].points.empty());
  EXPECT_TRUE(updates[lost].lines.empty());
  const auto trajectory = trajectoryOf(updates);
  EXPECT_LE(trajectory.front().first, flight.sim.frames[wrong].tracks.t_ns) << "where the accelerometer becomes right";
  std::vector<Eigen::Vector3d> estimate, truth;
  for (std::size_t i = 0, k = 0; i < trajectory.size(); ++i) {
    if (i > 0) {
      EXPECT_LE(trajectory[i].first - trajectory[i - 1].first, 50'000'000) << "a frame without a pose";
      EXPECT_GT(trajectory[i].first, trajectory[i - 1].first);
    }
    while (flight.sim.frames[k].tracks.t_ns != trajectory[i].first) ++k;
    estimate.push_back(trajectory[i].second.p);
    truth.push_back(flight.truth(k).state.T_w_b.p);
  }
  const Similarity T = alignPositions(AlignmentKind::kYaw, estimate, truth);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (T * estimate[i] - truth[i]).squaredNorm();
  EXPECT_LT(std::sqrt(sum / static_cast<double>(truth.size())), 0.1);
}

}  // namespace
}  // namespace lintel
