// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/ImuSimulator.h"

#include <cmath>
#include <stdexcept>

#include "lintel/geometry/Frames.h"
#include "lintel/simulation/Random.h"

namespace lintel {

std::int64_t imuStep_ns(const Rig& rig) {
  const std::int64_t step = rig.imu_rate_hz > 0 ? std::llround(1e9 / rig.imu_rate_hz) : 0;
  if (step <= 0 || step % 100 != 0) {
    throw std::invalid_argument("IMU rate " + std::to_string(rig.imu_rate_hz) +
                                " Hz: no whole number of 100 ns a step");
  }
  return step;
}

int imuPerFrame(const Rig& rig) {
  const double ratio = rig.imu_rate_hz / rig.camera_rate_hz;
  const int whole = static_cast<int>(std::lround(ratio));
  if (whole < 1 || std::abs(ratio - whole) > 1e-9) {
    throw std::invalid_argument("the IMU's rate is not a multiple of the camera's");
  }
  return whole;
}

SimulatedImu simulateImu(const Trajectory& trajectory, const Rig& rig, const ImuSimulatorParams& params,
                         std::size_t count, std::int64_t start_ns) {
  const std::int64_t step_ns = imuStep_ns(rig);
  const double step_s = 1e-9 * static_cast<double>(step_ns), scale = params.noise ? params.noise_scale : 0;
  const double sigma_gyro = scale * rig.imu_noise.gyro_noise / std::sqrt(step_s);
  const double sigma_accel = scale * rig.imu_noise.accel_noise / std::sqrt(step_s);
  const double walk = scale * params.walk_scale;
  const double walk_gyro = walk * rig.imu_noise.gyro_walk * std::sqrt(step_s);
  const double walk_accel = walk * rig.imu_noise.accel_walk * std::sqrt(step_s);

  const Eigen::Vector3d g_w = gravityW(rig.gravity_m_s2);
  RandomStream start(params.seed, 0x62696173), white(params.seed, 0x696d75), steps(params.seed, 0x77616c6b);
  InertialTruth truth;
  if (params.biases) {
    truth.bias_gyro = start.gaussian3(params.initial_gyro_bias);
    truth.bias_accel = start.gaussian3(params.initial_accel_bias);
  }
  SimulatedImu imu;
  imu.samples.reserve(count);
  imu.truth.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    truth.t_ns = start_ns + static_cast<std::int64_t>(k) * step_ns;
    truth.state = trajectory.at(1e-9 * static_cast<double>(truth.t_ns - start_ns));
    const Eigen::Quaterniond R_b_w = truth.state.T_w_b.q.conjugate();
    imu.truth.push_back(truth);
    imu.samples.push_back({truth.t_ns, truth.state.omega_b + truth.bias_gyro + white.gaussian3(sigma_gyro),
                           R_b_w * (truth.state.a_w_b - g_w) + truth.bias_accel + white.gaussian3(sigma_accel)});
    truth.bias_gyro += steps.gaussian3(walk_gyro);
    truth.bias_accel += steps.gaussian3(walk_accel);
  }
  return imu;
}

}  // namespace lintel
