// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/FigureTrajectory.h"

#include <algorithm>
#include <cmath>

#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/Random.h"

namespace lintel {

namespace {

constexpr double kTwoPi = 6.283185307179586;

/// Camera axes (right, down, forward) in n (forward, left, up).
Eigen::Quaterniond cameraInForwardLeftUp() {
  Eigen::Matrix3d R_n_c;
  R_n_c << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(R_n_c);
}

HarmonicSum::Sine sine(double amplitude, double frequency_hz, double phase_rad = 0) {
  return {amplitude, kTwoPi * frequency_hz, phase_rad};
}

std::array<HarmonicSum, 3> positionChannels(const FigureParams& p) {
  const Eigen::Vector3d shake = (p.shake * Eigen::Vector3d(0.04, 0.035, 0.03)).cwiseMin(p.half_extent);
  const Eigen::Vector3d main = p.half_extent - shake;
  const double f = 1 / p.period_s;
  std::array<HarmonicSum, 3> xyz;
  xyz[0].sines = {sine(main.x(), f), sine(shake.x(), 0.9, 0.4)};
  xyz[1].sines = {sine(main.y(), 2 * f, 0.3), sine(shake.y(), 1.1, 1.9)};
  xyz[2].sines = {sine(main.z(), 1.7 * f, 1.0), sine(shake.z(), 1.3, 2.7)};
  for (int i = 0; i < 3; ++i) {
    xyz[i].constant = p.centre[i];
    for (auto& s : xyz[i].sines) s.amplitude *= p.translation;
  }
  return xyz;
}

std::array<HarmonicSum, 3> attitudeChannels(const FigureParams& p) {
  std::array<HarmonicSum, 3> ypr;
  ypr[0].sines = {sine(p.sweep_rad, 0.13), sine(0.06 * p.shake, 0.7, 1.2)};
  ypr[1].sines = {sine(0.15, 0.17, 2.0), sine(0.03 * p.shake, 0.95)};
  ypr[2].sines = {sine(0.12, 0.21, 0.7), sine(0.05 * p.shake, 0.8, 2.4)};
  for (auto& angle : ypr) {
    for (auto& s : angle.sines) s.amplitude *= p.rotation;
  }
  ypr[0].constant = p.heading_rad;
  ypr[0].drift_per_s = p.turn_rate_rad_s * p.rotation;
  ypr[1].constant = p.pitch_rad;
  return ypr;
}

void drawPhases(std::array<HarmonicSum, 3>& channels, RandomStream& random) {
  for (auto& channel : channels) {
    for (auto& s : channel.sines) s.phase_rad = random.uniform(0, kTwoPi);
  }
}

}  // namespace

std::array<double, 3> HarmonicSum::at(double t_s) const {
  std::array<double, 3> sum{constant + drift_per_s * t_s, drift_per_s, 0};
  for (const Sine& s : sines) {
    const double angle = s.rate_rad_s * t_s + s.phase_rad, value = s.amplitude * std::sin(angle);
    sum[0] += value;
    sum[1] += s.amplitude * s.rate_rad_s * std::cos(angle);
    sum[2] -= s.rate_rad_s * s.rate_rad_s * value;
  }
  return sum;
}

FigureTrajectory::FigureTrajectory(const FigureParams& params) : FigureTrajectory(params, eurocRig().T_b_c.q) {}

FigureTrajectory::FigureTrajectory(const FigureParams& params, const Eigen::Quaterniond& R_b_c)
    : R_n_b_((cameraInForwardLeftUp() * R_b_c.conjugate()).normalized()),
      position_(positionChannels(params)),
      attitude_(attitudeChannels(params)) {
  if (params.seed != 0) {
    RandomStream random(params.seed, 0x666967);
    drawPhases(position_, random);
    drawPhases(attitude_, random);
  }
}

KinematicState FigureTrajectory::at(double t_s) const {
  KinematicState state;
  for (int i = 0; i < 3; ++i) {
    const auto [value, first, second] = position_[i].at(t_s);
    state.T_w_b.p[i] = value;
    state.v_w_b[i] = first;
    state.a_w_b[i] = second;
  }
  const auto yaw = attitude_[0].at(t_s), pitch = attitude_[1].at(t_s), roll = attitude_[2].at(t_s);
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Quaterniond R_w_n = AngleAxisd(yaw[0], Vector3d::UnitZ()) * AngleAxisd(pitch[0], Vector3d::UnitY()) *
                                   AngleAxisd(roll[0], Vector3d::UnitX());
  const double sp = std::sin(pitch[0]), cp = std::cos(pitch[0]), sr = std::sin(roll[0]), cr = std::cos(roll[0]);
  const Vector3d omega_n(roll[1] - yaw[1] * sp, pitch[1] * cr + yaw[1] * cp * sr, -pitch[1] * sr + yaw[1] * cp * cr);
  state.T_w_b.q = (R_w_n * R_n_b_).normalized();
  state.omega_b = R_n_b_.conjugate() * omega_n;
  return state;
}

}  // namespace lintel
