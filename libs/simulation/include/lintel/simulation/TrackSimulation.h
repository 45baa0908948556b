// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"
#include "lintel/geometry/Segment.h"
#include "lintel/simulation/ImuSimulator.h"
#include "lintel/simulation/Trajectory.h"

namespace lintel {

/// Feature tracks without images: what a perfect front end (plus chosen faults) gives for known points and lines.
struct TrackSimulationParams {
  double duration_s = 10;  ///< from the first frame to the last
  double lead_in_s = 0.5;  ///< IMU before the first frame; whole IMU steps. The first frame is at this trajectory time
  int points = 1500;       ///< points round the path, all about
  int lines = 320;         ///< lines round the path, all about
  int max_points_per_frame = 150;    ///< those tracked longest stay
  int max_lines_per_frame = 60;      ///< those tracked longest stay
  std::vector<Segment3> lines_w;     ///< lines of your own, in place of those round the path; group -1
  double axis_parallel_share = 0.7;  ///< share of the lines that are parallel to an axis of the world
  double margin_m = 2.5;             ///< the landmarks' shell is this far outside the path's bounding box
  double border_px = 4;              ///< nothing is seen nearer to the image's border
  double min_line_px = 50;           ///< shorter views of a line are no observations
  double point_noise_px = 0;         ///< standard deviation per axis
  double line_noise_px = 0;          ///< standard deviation of a line's end, across the line
  double line_end_jitter_px = 0;     ///< standard deviation of a line's end, along the line (fragmentation)
  double outlier_share = 0;          ///< share of the point observations displaced by up to 30 px
  std::uint64_t seed = 1;
};

/// One simulated frame: what the front end and the recording deliver, and the truth at its time.
struct SimulatedFrame {
  FrameTracks tracks;
  ImuBatch imu;         ///< as FrameWithImu::imu: from the frame before (the first: the lead-in) to this one
  InertialTruth truth;  ///< at tracks.t_ns
};

struct SimulatedTracks {
  std::vector<Eigen::Vector3d> points_w;  ///< [m]
  std::vector<Segment3> lines_w;          ///< [m]
  std::vector<int> line_groups;           ///< per line: 0, 1, 2 = parallel to x, y, z; -1 = none
  std::vector<std::size_t>
      point_of_track;  ///< index into points_w by TrackId: one that was lost comes back with a new id
  std::vector<std::size_t> line_of_track;  ///< index into lines_w by TrackId
  std::vector<SimulatedFrame> frames;
};

/// Simulates tracks and IMU along `trajectory`. Nothing occludes anything. Throws std::invalid_argument for rates that
/// do not fit together or a recording that does not fit into the trajectory.
SimulatedTracks simulateTracks(const Trajectory& trajectory, const Rig& rig, const ImuSimulatorParams& imu_params = {},
                               const TrackSimulationParams& params = {});

}  // namespace lintel
