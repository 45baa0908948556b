// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"
#include "lintel/simulation/Trajectory.h"

namespace lintel {

/// When a simulated recording starts. A multiple of 100 ns, as rawlogs keep no more.
constexpr std::int64_t kSimulationStart_ns = 1'400'000'000'000'000'000;

struct ImuSimulatorParams {
  bool noise = true;                 ///< white noise and bias walk with the rig's densities
  bool biases = true;                ///< initial biases; false: zero (they still walk if `noise`)
  double initial_gyro_bias = 0.02;   ///< standard deviation of the initial bias per axis [rad/s]
  double initial_accel_bias = 0.06;  ///< the same of the accelerometer [m/s^2]
  double noise_scale = 1;            ///< scales all four densities; sensor.yaml keeps the rig's
  double walk_scale = 1;             ///< scales the biases' walks in addition: how fast they drift
  std::uint64_t seed = 1;

  template <class F>
  void fields(F&& field) {
    field("noise", noise);
    field("biases", biases);
    field("initial_gyro_bias", initial_gyro_bias);
    field("initial_accel_bias", initial_accel_bias);
    field("noise_scale", noise_scale);
    field("walk_scale", walk_scale);
    field("seed", seed);
  }
};

/// What was true when an IMU sample was taken.
struct InertialTruth {
  std::int64_t t_ns = 0;
  KinematicState state;
  Eigen::Vector3d bias_gyro = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d bias_accel = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// Samples and truth, one each per instant, equal stamps.
struct SimulatedImu {
  std::vector<ImuSample> samples;
  std::vector<InertialTruth> truth;
};

/// The IMU's step [ns]. Throws std::invalid_argument unless the rate is positive and the step a multiple of 100 ns.
std::int64_t imuStep_ns(const Rig& rig);

/// IMU samples from one frame to the next. Throws std::invalid_argument unless the IMU's rate is a multiple of the
/// camera's, so that every image falls on an IMU sample.
int imuPerFrame(const Rig& rig);

/// Simulates `count` samples at t0 + k steps, t0 = trajectory time 0 = `start_ns`:
///   gyro  = omega_b + bias_gyro + noise,   accel = R_b_w (a_w_b - g_w) + bias_accel + noise,
/// instantaneous values; noise of a sample has the density times sqrt(rate), the biases walk by density times
/// sqrt(step).
SimulatedImu simulateImu(const Trajectory& trajectory, const Rig& rig, const ImuSimulatorParams& params,
                         std::size_t count, std::int64_t start_ns = kSimulationStart_ns);

}  // namespace lintel
