// SPDX-License-Identifier: BSD-3-Clause
#include "EstimationStage.h"

#include <gtest/gtest.h>

#include <set>

#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/FigureTrajectory.h"
#include "lintel/simulation/TrackSimulation.h"

namespace lintel {
namespace {

/// A flight whose accelerometer shows three times the motion in its first frames; gravity stays.
std::vector<TrackedFrame> flightWithWrongBeginning(const Rig& rig, int wrong_frames) {
  TrackSimulationParams params;
  params.duration_s = 8;
  std::vector<TrackedFrame> flight;
  for (const SimulatedFrame& frame : simulateTracks(FigureTrajectory(), rig, ImuSimulatorParams{}, params).frames) {
    TrackedFrame tracked;
    tracked.tracks = frame.tracks;
    tracked.step.frame.t_ns = frame.tracks.t_ns;
    tracked.step.imu = frame.imu;
    if (wrong_frames-- > 0)
      for (ImuSample& sample : tracked.step.imu) {
        const Eigen::Vector3d up_b = frame.truth.state.T_w_b.q.conjugate() * -gravityW();
        sample.accel = up_b + 3 * (sample.accel - up_b);
      }
    flight.push_back(tracked);
  }
  return flight;
}

TEST(EstimationStage, PosesOfAWrongStartAreLeftOut) {
  const Rig rig = eurocRig();
  Configuration configuration;
  configuration.refinement.enabled = configuration.densification.enabled = false;
  OdometryResult result;
  EstimationStage stage(rig, configuration, result);
  std::size_t given = 0, withdrawn = 0, replaced = 0;
  double first_start_s = 0;
  for (const TrackedFrame& frame : flightWithWrongBeginning(rig, 36)) {
    const WindowUpdate update = stage.process(frame);
    given += update.hasPose();
    if (update.startWasWrong()) {
      withdrawn = given;
      EXPECT_TRUE(result.trajectory.empty());
      EXPECT_LT(result.statistics.first_pose_s, 0);
      first_start_s = result.statistics.first_start_s;
    }
    replaced += update.replaced.size();
  }
  const OdometryStatistics& s = result.statistics;
  ASSERT_EQ(s.resets, 1u);
  EXPECT_GT(withdrawn, 0u);
  EXPECT_GT(replaced, 0u);
  EXPECT_EQ(result.trajectory.size(), given - withdrawn + replaced);
  EXPECT_EQ(s.frames_with_pose, result.trajectory.size());
  EXPECT_EQ(s.first_start_s, first_start_s);
  EXPECT_NEAR(s.first_pose_s, 1e-9 * static_cast<double>(result.trajectory.front().t_ns - s.first_frame_ns), 1e-9);
  EXPECT_GE(s.first_pose_s, s.first_start_s);
  stage.finish({});
  std::set<FrameId> ids;
  ASSERT_FALSE(result.map.keyframes.empty());
  EXPECT_GE(result.map.keyframes.front().t_ns, result.trajectory.front().t_ns - 3'000'000'000)
      << "none of the withdrawn";
  for (const MapKeyframe& keyframe : result.map.keyframes) EXPECT_TRUE(ids.insert(keyframe.id).second);
}

/// A flight whose IMU has no samples from one frame to another.
OdometryResult flightWithoutImu(double from_s, double to_s) {
  const Rig rig = eurocRig();
  Configuration configuration;
  configuration.refinement.enabled = configuration.densification.enabled = false;
  OdometryResult result;
  EstimationStage stage(rig, configuration, result);
  std::vector<TrackedFrame> flight = flightWithWrongBeginning(rig, 0);
  for (TrackedFrame& frame : flight) {
    const double t_s = 1e-9 * static_cast<double>(frame.tracks.t_ns - flight.front().tracks.t_ns);
    if (t_s > from_s && t_s < to_s) frame.step.imu.clear();
    stage.process(frame);
  }
  stage.finish({});
  EXPECT_FALSE(result.map.keyframes.empty());
  return result;
}

TEST(EstimationStage, AnImuThatEndsBeforeTheLastImagesIsNoReset) {
  const OdometryResult result = flightWithoutImu(7.7, 100);
  const OdometryStatistics& s = result.statistics;
  ASSERT_GT(s.frames_with_pose, 100u);
  EXPECT_LT(result.trajectory.back().t_ns, s.last_frame_ns - 150'000'000);
  EXPECT_EQ(s.resets, 0u);
  EXPECT_TRUE(s.failures.empty());
}

TEST(EstimationStage, AnImuThatEndsLongBeforeTheImagesOrComesBackIsOne) {
  EXPECT_EQ(flightWithoutImu(6, 100).statistics.resets, 1u);
  const OdometryStatistics s = flightWithoutImu(4, 4.3).statistics;
  EXPECT_EQ(s.resets, 1u);
  EXPECT_EQ(s.failures.size(), 1u);
}

}  // namespace
}  // namespace lintel
