// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/TrackSimulation.h"

#include <gtest/gtest.h>

#include <map>

#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/FigureTrajectory.h"

namespace lintel {
namespace {

SimulatedTracks tracks(const TrackSimulationParams& params = {}) {
  return simulateTracks(FigureTrajectory(), eurocRig(), {}, params);
}

TEST(TrackSimulation, ObservationsAreTheLandmarksProjections) {
  const SimulatedTracks sim = tracks();
  const Rig rig = eurocRig();
  ASSERT_EQ(sim.frames.size(), 201u);
  for (const SimulatedFrame& f : sim.frames) {
    const Pose T_c_w = (f.truth.state.T_w_b * rig.T_b_c).inverse();
    ASSERT_GT(f.tracks.points.size(), 60u);
    ASSERT_GT(f.tracks.lines.size(), 10u);
    for (const PointObservation& o : f.tracks.points) {
      const Eigen::Vector3d p_c = T_c_w * sim.points_w[sim.point_of_track[o.id]];
      ASSERT_NEAR((rig.camera.rayTo(p_c) - o.ray).norm(), 0, 1e-9);
      ASSERT_TRUE(rig.camera.contains(o.px, 4));
    }
    for (const LineObservation& o : f.tracks.lines) {
      const Segment3& s = sim.lines_w[sim.line_of_track[o.id]];
      const Eigen::Vector3d normal = (T_c_w * s.start).cross(T_c_w * s.end).normalized();  // plane through the camera
      ASSERT_NEAR(normal.dot(o.start), 0, 1e-9);
      ASSERT_NEAR(normal.dot(o.end), 0, 1e-9);
      ASSERT_GE((o.end_px - o.start_px).norm(), 50);
    }
  }
}

TEST(TrackSimulation, TracksLiveWithoutGapsAndLong) {
  const SimulatedTracks sim = tracks();
  std::map<TrackId, std::pair<std::size_t, int>> last;  // frame, length
  int longest = 0;
  for (std::size_t k = 0; k < sim.frames.size(); ++k) {
    TrackId before = 0;
    for (const PointObservation& o : sim.frames[k].tracks.points) {
      ASSERT_TRUE(before == 0 || o.id > before);
      before = o.id;
      const auto known = last.find(o.id);
      if (known == last.end()) {
        ASSERT_EQ(o.track_length, 1);
      } else {
        ASSERT_EQ(known->second.first + 1, k);
        ASSERT_EQ(known->second.second + 1, o.track_length);
      }
      last[o.id] = {k, o.track_length};
      longest = std::max(longest, o.track_length);
    }
  }
  EXPECT_GT(longest, 30);
}

TEST(TrackSimulation, ImuBatchesJoinAndEndAtTheFrames) {
  const SimulatedTracks sim = tracks();
  EXPECT_EQ(sim.frames[0].imu.size(), 101u);
  for (std::size_t k = 1; k < sim.frames.size(); ++k) {
    ASSERT_EQ(sim.frames[k].imu.size(), 11u);
    ASSERT_EQ(sim.frames[k].imu.front().t_ns, sim.frames[k - 1].tracks.t_ns);
    ASSERT_EQ(sim.frames[k].imu.back().t_ns, sim.frames[k].tracks.t_ns);
    ASSERT_EQ(sim.frames[k].imu.front().gyro, sim.frames[k - 1].imu.back().gyro);
    ASSERT_EQ(sim.frames[k].truth.t_ns, sim.frames[k].tracks.t_ns);
  }
}

TEST(TrackSimulation, NoiseHasTheGivenSize) {
  TrackSimulationParams noisy;
  noisy.point_noise_px = 0.7;
  noisy.line_noise_px = 0.5;
  noisy.line_end_jitter_px = 6;
  const SimulatedTracks clean = tracks(), sim = tracks(noisy);
  double points = 0, across = 0;
  int n_points = 0, n_lines = 0;
  for (std::size_t k = 0; k < sim.frames.size(); ++k) {
    const FrameTracks &a = clean.frames[k].tracks, &b = sim.frames[k].tracks;
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i, ++n_points)
      points += (a.points[i].px - b.points[i].px).squaredNorm();
    for (std::size_t i = 0; i < a.lines.size(); ++i, ++n_lines) {
      const Eigen::Vector2d d = (a.lines[i].end_px - a.lines[i].start_px).normalized();
      const Eigen::Vector2d e = b.lines[i].end_px - a.lines[i].end_px;
      across += std::pow(d.x() * e.y() - d.y() * e.x(), 2);
    }
  }
  EXPECT_NEAR(std::sqrt(points / (2 * n_points)), 0.7, 0.02);
  EXPECT_NEAR(std::sqrt(across / n_lines), 0.5, 0.03);
}

TEST(TrackSimulation, AShortTrajectoryIsRefused) {
  class Short : public FigureTrajectory {
   public:
    double duration() const override { return 3; }
  };
  EXPECT_THROW(simulateTracks(Short(), eurocRig()), std::invalid_argument);
}

}  // namespace
}  // namespace lintel
