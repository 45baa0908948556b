// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"
#include "lintel/geometry/Frames.h"

namespace lintel {

/// IMU biases, assumed constant over one pre-integration.
struct ImuBias {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// Relative motion between two times from IMU samples alone, independent of the state at the start [Forster2017]:
///   delta_R = R_bi_bj,  delta_v = R_bi_w (v_j - v_i - g dt),  delta_p = R_bi_w (p_j - p_i - v_i dt - g dt^2 / 2),
/// by midpoint integration, with first-order Jacobians by biases and axes (ImuAxes) and the covariance of the error
/// (theta, v, p). The bias is that of the interval's start; by how much correlated noise (ImuNoise) leaves it is in the
/// covariance.
class Preintegration {
 public:
  using Matrix9 = Eigen::Matrix<double, 9, 9>;
  using Matrix96 = Eigen::Matrix<double, 9, 6>;
  using AxesJacobian = Eigen::Matrix<double, 9, 15>;

  /// Order of the error state of covariance and Jacobians.
  enum Order { kTheta = 0, kVelocity = 3, kPosition = 6 };

  /// `gravity_m_s2`: where the samples were taken; the deltas do not depend on it, the states between which they are
  /// do.
  Preintegration(const ImuBias& bias, const ImuNoise& noise, double gravity_m_s2 = kGravity)
      : bias_(bias), noise_(noise), gravity_m_s2_(gravity_m_s2) {}

  /// Appends samples; the first one must be the last of those before (or start the interval).
  void append(const ImuBatch& samples);

  /// Appends another interval that starts where this one ends (used when a frame between two is dropped).
  void append(const Preintegration& next) { append(next.samples_); }

  /// Integrates all samples again with other biases as the point of linearisation.
  void repropagate(const ImuBias& bias);

  /// Takes what is larger of its noise and this; integrates all samples again when that changes a density.
  void raiseNoise(const ImuNoise& least);

  /// For an interval whose accelerometer is to be taken at its word: its correlated noise becomes zero.
  void leaveOutCorrelatedNoise() { noise_.accel_correlated = 0; }

  /// What the covariance has more because the times of both ends are uncertain, by sigma_s each; replaces what was set
  /// before, and stays when samples are appended (countStampJitter()).
  void setStampNoise(double sigma_s, const Matrix9& covariance) {
    stamp_sigma_s_ = sigma_s;
    stamp_covariance_ = covariance;
  }

  double dt_s() const { return dt_s_; }
  const ImuBias& bias() const { return bias_; }
  const ImuNoise& noise() const { return noise_; }
  double gravity_m_s2() const { return gravity_m_s2_; }
  Eigen::Vector3d gravityW() const { return lintel::gravityW(gravity_m_s2_); }
  const ImuBatch& samples() const { return samples_; }
  const Eigen::Quaterniond& deltaR() const { return delta_R_; }
  const Eigen::Vector3d& deltaV() const { return delta_v_; }
  const Eigen::Vector3d& deltaP() const { return delta_p_; }

  /// d (theta, v, p) / d (bias_gyro, bias_accel).
  const Matrix96& biasJacobian() const { return bias_jacobian_; }

  /// d (theta, v, p) / d (A, G) of the axes (ImuAxes) about none: the rows of A one after the other, then xx, yy, zz,
  /// xy, xz, yz of G. By A it is exact, as velocity and position are linear in it, by G to first order.
  AxesJacobian axesJacobian(const Eigen::Vector3d& mean_f) const;

  Matrix9 covariance() const { return covariance_ + stamp_covariance_ + correlatedCovariance(); }
  double stampSigma() const { return stamp_sigma_s_; }  ///< [s]
  const Matrix9& stampCovariance() const { return stamp_covariance_; }

  /// Deltas corrected to first order for biases other than bias() [Forster2017, eq. 44].
  struct Corrected {
    Eigen::Quaterniond delta_R;
    Eigen::Vector3d delta_v, delta_p;
    Eigen::Vector3d delta_theta;  ///< the rotation correction J_gyro * (bias - bias())
  };
  Corrected corrected(const ImuBias& bias) const;

 private:
  void integrate(const ImuSample& s0, const ImuSample& s1);
  void reset();
  Matrix9 correlatedCovariance() const;

  ImuBias bias_;
  ImuNoise noise_;
  double gravity_m_s2_;
  ImuBatch samples_;
  double dt_s_ = 0;
  Eigen::Quaterniond delta_R_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d delta_v_ = Eigen::Vector3d::Zero(), delta_p_ = Eigen::Vector3d::Zero();
  Matrix96 bias_jacobian_ = Matrix96::Zero();
  Eigen::Matrix<double, 6, 9> accel_axes_jacobian_ = Eigen::Matrix<double, 6, 9>::Zero();  // (v, p) by A, no mean_f
  Matrix96 gyro_axes_jacobian_ = Matrix96::Zero();                                         // (theta, v, p) by G
  Matrix9 covariance_ = Matrix9::Zero();                                                   // by the samples
  Matrix9 stamp_covariance_ = Matrix9::Zero();
  double stamp_sigma_s_ = 0;
};

}  // namespace lintel
