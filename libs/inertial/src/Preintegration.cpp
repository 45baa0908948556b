// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/Preintegration.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/UnmeasuredMotion.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// d (R A f) / d A.
Eigen::Matrix<double, 3, 9> byAxes(const Eigen::Matrix3d& R, const Eigen::Vector3d& f) {
  Eigen::Matrix<double, 3, 9> J;
  for (int row = 0; row < 3; ++row) J.middleCols<3>(3 * row) = R.col(row) * f.transpose();
  return J;
}

/// d (G w) / d G of a symmetric G.
Eigen::Matrix<double, 3, 6> bySymmetric(const Eigen::Vector3d& w) {
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.leftCols<3>().diagonal() = w;
  J.rightCols<3>() << w.y(), w.z(), 0, w.x(), 0, w.z(), 0, w.x(), w.y();
  return J;
}

}  // namespace

void Preintegration::append(const ImuBatch& samples) {
  samples_.reserve(samples_.size() + samples.size());  // no more: the map keeps thousands of these
  for (const ImuSample& sample : samples) {
    if (!samples_.empty()) {
      if (sample.t_ns <= samples_.back().t_ns) continue;  // the shared end of two batches
      integrate(samples_.back(), sample);
    }
    samples_.push_back(sample);
  }
}

void Preintegration::reset() {
  dt_s_ = 0;
  delta_R_.setIdentity();
  delta_v_.setZero();
  delta_p_.setZero();
  bias_jacobian_.setZero();
  accel_axes_jacobian_.setZero();
  gyro_axes_jacobian_.setZero();
  covariance_.setZero();
}

void Preintegration::repropagate(const ImuBias& bias) {
  bias_ = bias;
  reset();
  for (std::size_t i = 1; i < samples_.size(); ++i) integrate(samples_[i - 1], samples_[i]);
}

void Preintegration::raiseNoise(const ImuNoise& least) {
  const ImuNoise raised{std::max(noise_.gyro_noise, least.gyro_noise), std::max(noise_.gyro_walk, least.gyro_walk),
                        std::max(noise_.accel_noise, least.accel_noise), std::max(noise_.accel_walk, least.accel_walk),
                        std::max(noise_.accel_correlated, least.accel_correlated)};
  const bool same = raised.gyro_noise == noise_.gyro_noise && raised.accel_noise == noise_.accel_noise;
  noise_ = raised;
  if (!same) repropagate(bias_);  // the others are not integrated
}

void Preintegration::integrate(const ImuSample& s0, const ImuSample& s1) {
  const double dt = 1e-9 * static_cast<double>(s1.t_ns - s0.t_ns), dt2 = dt * dt;
  const Eigen::Vector3d gyro_mean = 0.5 * (s0.gyro + s1.gyro), phi = (gyro_mean - bias_.gyro) * dt;
  const Eigen::Quaterniond step = expRotation(phi);
  const Eigen::Quaterniond R1 = (delta_R_ * step).normalized();
  const Eigen::Vector3d a0 = s0.accel - bias_.accel, a1 = s1.accel - bias_.accel;
  const Eigen::Vector3d a = 0.5 * (delta_R_ * a0 + R1 * a1);  // mean specific force in the frame of the start

  // Linearised error propagation x <- A x + B noise, x = (theta, v, p), theta a right perturbation of delta_R.
  const Eigen::Matrix3d R0m = delta_R_.toRotationMatrix(), R1m = R1.toRotationMatrix(), Rm = 0.5 * (R0m + R1m);
  const Eigen::Matrix3d step_inverse = step.toRotationMatrix().transpose(), Jr_dt = rightJacobian(phi) * dt;
  const Eigen::Matrix3d a1_skew = skew(a1);
  const Eigen::Matrix3d da_dtheta = -0.5 * (R0m * skew(a0) + R1m * a1_skew * step_inverse);
  const Eigen::Matrix3d da_dgyro = -0.5 * R1m * a1_skew * Jr_dt;  // through the rotation at the end of the step

  Matrix9 A = Matrix9::Identity();
  A.block<3, 3>(kTheta, kTheta) = step_inverse;
  A.block<3, 3>(kVelocity, kTheta) = da_dtheta * dt;
  A.block<3, 3>(kPosition, kTheta) = 0.5 * da_dtheta * dt2;
  A.block<3, 3>(kPosition, kVelocity) = Eigen::Matrix3d::Identity() * dt;
  Matrix96 B;  // d x / d (gyro, accel) measured
  B.block<3, 3>(kTheta, 0) = Jr_dt;
  B.block<3, 3>(kVelocity, 0) = da_dgyro * dt;
  B.block<3, 3>(kPosition, 0) = 0.5 * da_dgyro * dt2;
  B.block<3, 3>(kTheta, 3).setZero();
  B.block<3, 3>(kVelocity, 3) = Rm * dt;
  B.block<3, 3>(kPosition, 3) = 0.5 * Rm * dt2;

  bias_jacobian_ = A * bias_jacobian_ - B;  // a bias is subtracted from the measurement
  const Eigen::Matrix<double, 3, 9> a_by_A = 0.5 * (byAxes(R0m, s0.accel) + byAxes(R1m, s1.accel));
  accel_axes_jacobian_.bottomRows<3>() += dt * accel_axes_jacobian_.topRows<3>() + 0.5 * dt2 * a_by_A;
  accel_axes_jacobian_.topRows<3>() += dt * a_by_A;
  gyro_axes_jacobian_ = A * gyro_axes_jacobian_ + B.leftCols<3>() * bySymmetric(gyro_mean);
  Eigen::Matrix<double, 6, 1> variance;
  const double gyro = std::max<double>({s1.bridged ? kUnmeasuredGyro : noise_.gyro_noise, s0.gyro_open, s1.gyro_open});
  const double accel =
      std::max<double>({s1.bridged ? kUnmeasuredAccel : noise_.accel_noise, s0.accel_open, s1.accel_open});
  variance << Eigen::Vector3d::Constant(gyro * gyro / dt), Eigen::Vector3d::Constant(accel * accel / dt);
  covariance_ = A * covariance_ * A.transpose() + B * variance.asDiagonal() * B.transpose();
  // White noise moves the position within a step on its own: of accel^2 dt^3 / 3 the term in B holds three quarters.
  covariance_.block<3, 3>(kPosition, kPosition).diagonal().array() += accel * accel * dt * dt2 / 12;

  delta_p_ += delta_v_ * dt + 0.5 * a * dt2;
  delta_v_ += a * dt;
  delta_R_ = R1;
  dt_s_ += dt;
}

/// With e(t) the correlated noise, the integral v of e(t) - e(0) and the integral p of v have, in units of
/// its standard deviation and time constant, u for the time and E for exp(-u),
///   <v v> = u^2 + 2 u E + 2 E - 2,   <v p> = u^2 (u - 1 + E) / 2,   <p p> = u^4 / 4 - u^3 / 3 + 2 - (2 + 2 u + u^2) E.
/// That the body turns meanwhile is left out: all axes are alike.
Preintegration::Matrix9 Preintegration::correlatedCovariance() const {
  constexpr double kShort = 0.02, T = kAccelCorrelation_s;  // below, these differences are lost to rounding
  Matrix9 result = Matrix9::Zero();
  const double u = dt_s_ / T, u2 = u * u, u3 = u * u2, E = std::exp(-u);
  const double vv = u < kShort ? 2 * u3 / 3 : u2 + 2 * u * E + 2 * E - 2;
  const double vp = u < kShort ? u2 * u2 / 4 : u2 * (u - 1 + E) / 2;
  const double pp = u < kShort ? u2 * u3 / 10 : u2 * u2 / 4 - u3 / 3 + 2 - (2 + 2 * u + u2) * E;
  const double variance = noise_.accel_correlated * noise_.accel_correlated;
  result.block<3, 3>(kVelocity, kVelocity).diagonal().setConstant(variance * vv * T * T);
  result.block<3, 3>(kVelocity, kPosition).diagonal().setConstant(variance * vp * T * T * T);
  result.block<3, 3>(kPosition, kVelocity) = result.block<3, 3>(kVelocity, kPosition);
  result.block<3, 3>(kPosition, kPosition).diagonal().setConstant(variance * pp * T * T * T * T);
  return result;
}

/// What mean_f takes away is what a bias of A mean_f would.
Preintegration::AxesJacobian Preintegration::axesJacobian(const Eigen::Vector3d& mean_f) const {
  AxesJacobian J;
  J.topLeftCorner<3, 9>().setZero();
  J.bottomLeftCorner<6, 9>() = accel_axes_jacobian_;
  for (int row = 0; row < 3; ++row)
    J.block<6, 3>(kVelocity, 3 * row) += bias_jacobian_.block<6, 1>(kVelocity, 3 + row) * mean_f.transpose();
  J.rightCols<6>() = gyro_axes_jacobian_;
  return J;
}

Preintegration::Corrected Preintegration::corrected(const ImuBias& bias) const {
  Eigen::Matrix<double, 6, 1> change;
  change << bias.gyro - bias_.gyro, bias.accel - bias_.accel;
  const Eigen::Matrix<double, 9, 1> correction = bias_jacobian_ * change;
  Corrected c;
  c.delta_theta = correction.segment<3>(kTheta);
  c.delta_R = (delta_R_ * expRotation(c.delta_theta)).normalized();
  c.delta_v = delta_v_ + correction.segment<3>(kVelocity);
  c.delta_p = delta_p_ + correction.segment<3>(kPosition);
  return c;
}

}  // namespace lintel
