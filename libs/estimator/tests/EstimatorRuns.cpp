// SPDX-License-Identifier: BSD-3-Clause
#include "EstimatorRuns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lintel/geometry/Alignment.h"

namespace lintel::test {

std::vector<WindowUpdate> run(const TrackedFlight& flight, const EstimatorParams& params, bool lines) {
  Estimator estimator(flight.rig, params);
  std::vector<WindowUpdate> updates;
  for (const SimulatedFrame& frame : flight.sim.frames) {
    FrameTracks tracks = frame.tracks;
    if (!lines) tracks.lines.clear();
    updates.push_back(estimator.process(tracks, frame.imu));
  }
  updates.push_back(estimator.finish());
  return updates;
}

Positions positionsOf(const std::vector<WindowUpdate>& updates, const TrackedFlight& flight) {
  Positions p;
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k)
    if (updates[k].hasPose()) {
      p.estimate.push_back(updates[k].T_w_b.p);
      p.truth.push_back(flight.truth(k).state.T_w_b.p);
    }
  return p;
}

double positionError(const std::vector<WindowUpdate>& updates, const TrackedFlight& flight) {
  const auto [estimate, truth] = positionsOf(updates, flight);
  const Similarity T = alignPositions(AlignmentKind::kYaw, estimate, truth);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (T * estimate[i] - truth[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

int posesOf(const std::vector<WindowUpdate>& updates) {
  return static_cast<int>(std::count_if(updates.begin(), updates.end(), [](const auto& u) { return u.hasPose(); }));
}

int lostOf(const std::vector<WindowUpdate>& updates) {
  return static_cast<int>(
      std::count_if(updates.begin(), updates.end(), [](const auto& u) { return u.status == EstimatorStatus::kLost; }));
}

TrackSimulationParams tracksFor(double duration_s, double noise_px) {
  TrackSimulationParams tracks;
  tracks.duration_s = duration_s;
  tracks.max_points_per_frame = 80;
  tracks.max_lines_per_frame = 25;
  tracks.point_noise_px = tracks.line_noise_px = noise_px;
  return tracks;
}

EstimatorParams withoutCalibration() {
  EstimatorParams params;
  params.calibration.refine_camera = params.calibration.refine_extrinsics = params.calibration.refine_readout =
      params.calibration.refine_time_offset = false;
  return params;
}

void expectEachIdOnce(const std::vector<WindowUpdate>& updates) {
  std::set<FrameId> keyframes;
  std::set<TrackId> points, lines;
  for (const WindowUpdate& u : updates) {
    // a new start has a new world: what is still tracked is estimated and handed over again
    for (const auto& k : u.keyframes) EXPECT_TRUE(keyframes.insert(k.id).second) << "keyframe " << k.id << " twice";
    for (const auto& p : u.points) EXPECT_TRUE(points.insert(p.id).second) << "point " << p.id << " twice";
    for (const auto& l : u.lines) EXPECT_TRUE(lines.insert(l.id).second) << "line " << l.id << " twice";
    if (u.status == EstimatorStatus::kLost) points.clear(), lines.clear();
  }
}

}  // namespace lintel::test
