// SPDX-License-Identifier: BSD-3-Clause
#include "TestWindow.h"

#include <tuple>

namespace lintel::test {

Rig plainRig() {
  Rig rig;
  rig.camera = {640, 480, 500, 500, 319.5, 239.5, 0, 0, 0, 0};
  return rig;
}

SlidingWindow windowAt(const std::vector<Pose>& poses_w_b, const Rig& rig) {
  SlidingWindow window(rig);
  for (std::size_t i = 0; i < poses_w_b.size(); ++i) {
    WindowFrame frame;
    frame.id = i;
    frame.t_ns = static_cast<std::int64_t>(i) * 100'000'000;
    frame.pose = toBlock(poses_w_b[i]);
    window.addFrame(std::move(frame), {});
  }
  return window;
}

namespace {

Eigen::Vector2d pixelOf(const SlidingWindow& window, FrameId id, const Eigen::Vector3d& p_w) {
  return window.camera().project(window.T_w_c(window.frame(id)).inverse() * p_w);
}

RayObservation observed(const SlidingWindow& window, const Eigen::Vector2d& px) {
  return makeObservation(window.camera(), px);
}

}  // namespace

void seePoint(SlidingWindow& window, TrackId id, FrameId frame, const Eigen::Vector3d& p_w,
              const Eigen::Vector2d& noise_px) {
  const Eigen::Vector2d px = pixelOf(window, frame, p_w) + noise_px;
  PointTrack& track = window.points[id];
  track.id = id;
  track.sightings.push_back({frame, observed(window, px), px});
}

void seeLine(SlidingWindow& window, TrackId id, FrameId frame, const Segment3& segment_w,
             const Eigen::Vector2d& start_noise_px, const Eigen::Vector2d& end_noise_px) {
  const Eigen::Vector2d start_px = pixelOf(window, frame, segment_w.start) + start_noise_px;
  const Eigen::Vector2d end_px = pixelOf(window, frame, segment_w.end) + end_noise_px;
  LineTrack& track = window.lines[id];
  track.id = id;
  LineSighting sighting;
  sighting.frame = frame;
  std::tie(sighting.start, sighting.end) = makeLineEnds(window.camera(), start_px, end_px);
  sighting.start_px = start_px;
  sighting.end_px = end_px;
  track.sightings.push_back(sighting);
}

ImuSimulatorParams perfectImu() {
  ImuSimulatorParams imu;
  imu.noise = imu.biases = false;
  return imu;
}

TrackedFlight fly(const ImuSimulatorParams& imu, const TrackSimulationParams& tracks, const Trajectory& trajectory,
                  const Rig& rig) {
  TrackedFlight flight;
  flight.rig = rig;
  flight.sim = simulateTracks(trajectory, flight.rig, imu, tracks);
  return flight;
}

SlidingWindow bufferOf(const TrackedFlight& flight, std::size_t first, std::size_t count, std::size_t step) {
  SlidingWindow window(flight.rig);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = first + k * step;
    WindowFrame frame;
    frame.id = k;
    frame.t_ns = flight.sim.frames[at].tracks.t_ns;
    frame.gyro = flight.sim.frames[at].imu.back().gyro;
    if (k > 0) {
      frame.imu = std::make_shared<Preintegration>(ImuBias{}, flight.rig.imu_noise);
      for (std::size_t i = at - step + 1; i <= at; ++i) frame.imu->append(flight.sim.frames[i].imu);
    }
    window.addFrame(std::move(frame), flight.sim.frames[at].tracks);
  }
  return window;
}

SlidingWindow trueWindow(const TrackedFlight& flight, std::size_t first, std::size_t count, std::size_t step) {
  SlidingWindow window = bufferOf(flight, first, count, step);
  for (std::size_t k = 0; k < count; ++k) {
    const InertialTruth& truth = flight.truth(first + k * step);
    WindowFrame& frame = window.frames[k];
    frame.pose = toBlock(truth.state.T_w_b);
    frame.motion << truth.state.v_w_b, truth.bias_gyro, truth.bias_accel;
    if (frame.imu) frame.imu->repropagate({truth.bias_gyro, truth.bias_accel});
  }
  return window;
}

}  // namespace lintel::test
