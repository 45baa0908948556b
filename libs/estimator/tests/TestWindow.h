// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/FigureTrajectory.h"
#include "lintel/simulation/TrackSimulation.h"

namespace lintel::test {

inline const EstimatorParams kParams;  ///< the defaults

/// The defaults, but for tracks with white noise, as they are simulated.
inline EstimatorParams forWhiteNoise() {
  EstimatorParams params;
  params.factors.point_noise_px = params.factors.point_sigma_px;
  params.factors.line_noise_px = params.factors.line_sigma_px;
  params.factors.point_walk_px = params.factors.line_walk_px = 0;
  params.factors.find_track_noise = false;
  return params;
}

/// The defaults, but the residuals of a track are independent of each other: what Ceres can minimise.
inline FactorParams withoutTrackLoss() {
  FactorParams params = forWhiteNoise().factors;
  params.track_freedom = std::numeric_limits<double>::infinity();
  return params;
}

/// A rig that is easy to compute with by hand: no distortion, focal length 500 px, camera and body axes the same.
Rig plainRig();

/// A window whose frames have the given body poses, 0.1 s apart, ids from 0; no tracks, no IMU.
SlidingWindow windowAt(const std::vector<Pose>& poses_w_b, const Rig& rig = plainRig());

/// Pose at `p_w` with the camera of plainRig looking along the world's axes (z forward).
inline Pose at(double x, double y, double z) { return {Eigen::Quaterniond::Identity(), {x, y, z}}; }

/// Lets frame `id` see a world point (exactly, plus `noise_px`).
void seePoint(SlidingWindow& window, TrackId track, FrameId id, const Eigen::Vector3d& p_w,
              const Eigen::Vector2d& noise_px = Eigen::Vector2d::Zero());

/// Lets frame `id` see a world segment, whole, its ends moved by the given noise.
void seeLine(SlidingWindow& window, TrackId track, FrameId id, const Segment3& segment_w,
             const Eigen::Vector2d& start_noise_px = Eigen::Vector2d::Zero(),
             const Eigen::Vector2d& end_noise_px = Eigen::Vector2d::Zero());

/// Simulated tracks along the built-in figure.
struct TrackedFlight {
  Rig rig = eurocRig();
  SimulatedTracks sim;

  const InertialTruth& truth(std::size_t frame) const { return sim.frames[frame].truth; }
};

/// IMU without noise or biases.
ImuSimulatorParams perfectImu();

/// What every test flies unless it says otherwise: 10 s, no noise on the tracks.
TrackedFlight fly(const ImuSimulatorParams& imu, const TrackSimulationParams& tracks = {},
                  const Trajectory& trajectory = FigureTrajectory(), const Rig& rig = eurocRig());

/// `count` window frames, every `step`th frame of the flight from `first` on, pre-integrated with zero biases; no
/// states, as the estimator's buffer before initialisation. Frame ids count from 0.
SlidingWindow bufferOf(const TrackedFlight& flight, std::size_t first, std::size_t count, std::size_t step = 2);

/// The same with the true states (poses, velocities, biases).
SlidingWindow trueWindow(const TrackedFlight& flight, std::size_t first, std::size_t count, std::size_t step = 2);

}  // namespace lintel::test
