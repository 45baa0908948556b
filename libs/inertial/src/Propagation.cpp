// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/Propagation.h"

#include <Eigen/Cholesky>

#include "lintel/geometry/Rotation.h"

namespace lintel {

InertialState propagated(const InertialState& from, const Preintegration& imu) {
  const double dt = imu.dt_s();
  const auto delta = imu.corrected(from.bias);
  InertialState to;
  to.T_w_b.q = (from.T_w_b.q * delta.delta_R).normalized();
  to.T_w_b.p = from.T_w_b.p + from.v_w_b * dt + 0.5 * imu.gravityW() * dt * dt + from.T_w_b.q * delta.delta_p;
  to.v_w_b = from.v_w_b + imu.gravityW() * dt + from.T_w_b.q * delta.delta_v;
  to.bias = from.bias;
  return to;
}

std::vector<Preintegration> integratedTo(const ImuBias& bias, const Preintegration& whole,
                                         const std::vector<std::int64_t>& times_ns) {
  Preintegration imu(bias, whole.noise(), whole.gravity_m_s2());
  std::vector<Preintegration> integrated;
  std::size_t next = 0;
  const ImuBatch& samples = whole.samples();
  for (const std::int64_t t_ns : times_ns) {
    ImuBatch piece;
    while (next < samples.size() && samples[next].t_ns <= t_ns) piece.push_back(samples[next++]);
    imu.append(piece);
    integrated.push_back(imu);
    if (next == samples.size() || next == 0 || samples[next - 1].t_ns == t_ns) continue;
    const ImuSample &a = samples[next - 1], &b = samples[next];
    const double s = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    ImuSample between = a;
    between.t_ns = t_ns;
    between.gyro = a.gyro + s * (b.gyro - a.gyro);
    between.accel = a.accel + s * (b.accel - a.accel);
    integrated.back().append({between});
  }
  return integrated;
}

StateCovariance propagatedCovariance(const InertialState& from, const Preintegration& imu,
                                     const StateCovariance& covariance) {
  constexpr int kP = 0, kR = 3, kV = 6, kBias = 9;  // in the state; Preintegration has another order
  const double dt = imu.dt_s();
  const auto delta = imu.corrected(from.bias);
  const Eigen::Matrix3d R = from.T_w_b.R();
  const auto& by_bias = imu.biasJacobian();
  StateCovariance by_state = StateCovariance::Identity();
  by_state.block<3, 3>(kP, kV) = dt * Eigen::Matrix3d::Identity();
  by_state.block<3, 3>(kP, kR) = -R * skew(delta.delta_p);
  by_state.block<3, 6>(kP, kBias) = R * by_bias.middleRows<3>(Preintegration::kPosition);
  by_state.block<3, 3>(kV, kR) = -R * skew(delta.delta_v);
  by_state.block<3, 6>(kV, kBias) = R * by_bias.middleRows<3>(Preintegration::kVelocity);
  by_state.block<3, 3>(kR, kR) = delta.delta_R.toRotationMatrix().transpose();
  by_state.block<3, 6>(kR, kBias) = rightJacobian(delta.delta_theta) * by_bias.middleRows<3>(Preintegration::kTheta);
  Eigen::Matrix<double, 15, 9> by_noise = Eigen::Matrix<double, 15, 9>::Zero();
  by_noise.block<3, 3>(kP, Preintegration::kPosition) = R;
  by_noise.block<3, 3>(kV, Preintegration::kVelocity) = R;
  by_noise.block<3, 3>(kR, Preintegration::kTheta).setIdentity();
  StateCovariance result = by_state * covariance * by_state.transpose();
  result += by_noise * imu.covariance() * by_noise.transpose();
  const ImuNoise& noise = imu.noise();
  result.diagonal().segment<3>(kBias).array() += noise.gyro_walk * noise.gyro_walk * dt;
  result.diagonal().segment<3>(kBias + 3).array() += noise.accel_walk * noise.accel_walk * dt;
  return result;
}

namespace {

/// Of the later state, in the earlier body, in the order of Preintegration.
Eigen::Matrix<double, 9, 1> misfit(const InertialState& from, const InertialState& to, const Preintegration& imu) {
  const InertialState expected = propagated(from, imu);
  const Eigen::Quaterniond R_b_w = from.T_w_b.q.conjugate();
  Eigen::Matrix<double, 9, 1> r;
  r.segment<3>(Preintegration::kTheta) = logRotation(expected.T_w_b.q.conjugate() * to.T_w_b.q);
  r.segment<3>(Preintegration::kVelocity) = R_b_w * (to.v_w_b - expected.v_w_b);
  r.segment<3>(Preintegration::kPosition) = R_b_w * (to.T_w_b.p - expected.T_w_b.p);
  return r;
}

}  // namespace

double squaredMisfit(const InertialState& from, const InertialState& to, const Preintegration& imu) {
  const Eigen::Matrix<double, 9, 1> r = misfit(from, to, imu);
  return r.dot(imu.covariance().llt().solve(r));
}

double squaredAccelMisfit(const InertialState& from, const InertialState& to, const Preintegration& imu) {
  static_assert(Preintegration::kPosition == Preintegration::kVelocity + 3);
  const Eigen::Matrix<double, 6, 1> r = misfit(from, to, imu).segment<6>(Preintegration::kVelocity);
  const Eigen::Matrix<double, 6, 6> covariance =
      imu.covariance().block<6, 6>(Preintegration::kVelocity, Preintegration::kVelocity);
  return r.dot(covariance.llt().solve(r));
}

}  // namespace lintel
