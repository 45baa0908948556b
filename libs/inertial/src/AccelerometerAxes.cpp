// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/AccelerometerAxes.h"

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// d (R A f) / d A.
Eigen::Matrix<double, 3, 9> byAxes(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& f) {
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  Eigen::Matrix<double, 3, 9> J;
  for (int row = 0; row < 3; ++row) J.middleCols<3>(3 * row) = R.col(row) * f.transpose();
  return J;
}

}  // namespace

Eigen::Matrix3d followedBy(const Eigen::Matrix3d& first, const Eigen::Matrix3d& second) {
  return first + second + second * first;
}

/// The sums of Preintegration::integrate.
AxesJacobian axesJacobian(const Preintegration& imu, const Eigen::Vector3d& mean_f) {
  Eigen::Matrix<double, 3, 9> velocity = Eigen::Matrix<double, 3, 9>::Zero(), position = velocity;
  Eigen::Quaterniond R0 = Eigen::Quaterniond::Identity();
  for (std::size_t i = 1; i < imu.samples().size(); ++i) {
    const ImuSample &s0 = imu.samples()[i - 1], &s1 = imu.samples()[i];
    const double dt = 1e-9 * static_cast<double>(s1.t_ns - s0.t_ns);
    const Eigen::Quaterniond R1 = (R0 * expRotation((0.5 * (s0.gyro + s1.gyro) - imu.bias().gyro) * dt)).normalized();
    const Eigen::Matrix<double, 3, 9> a = 0.5 * (byAxes(R0, s0.accel - mean_f) + byAxes(R1, s1.accel - mean_f));
    position += velocity * dt + 0.5 * dt * dt * a;
    velocity += dt * a;
    R0 = R1;
  }
  AxesJacobian J;
  J << velocity, position;
  return J;
}

ImuBatch withAxes(ImuBatch samples, const AccelerometerAxes& axes) {
  for (ImuSample& sample : samples) sample.accel += axes.A * (sample.accel - axes.mean_f);
  return samples;
}

Preintegration withAxes(const Preintegration& imu, const AccelerometerAxes& axes) {
  if (axes.A.isZero(0)) return imu;
  Preintegration corrected(imu.bias(), imu.noise(), imu.gravity_m_s2());
  corrected.append(withAxes(imu.samples(), axes));
  if (imu.stampSigma() > 0) corrected.setStampNoise(imu.stampSigma(), imu.stampCovariance());
  return corrected;
}

}  // namespace lintel
