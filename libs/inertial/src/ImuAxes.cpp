// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/ImuAxes.h"

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix39 = Eigen::Matrix<double, 3, 9>;

/// d (R A f) / d A.
Matrix39 byAxes(const Eigen::Matrix3d& R, const Eigen::Vector3d& f) {
  Matrix39 J;
  for (int row = 0; row < 3; ++row) J.middleCols<3>(3 * row) = R.col(row) * f.transpose();
  return J;
}

/// d (G w) / d G of a symmetric G.
Matrix36 bySymmetric(const Eigen::Vector3d& w) {
  Matrix36 J = Matrix36::Zero();
  J.leftCols<3>().diagonal() = w;
  J.rightCols<3>() << w.y(), w.z(), 0, w.x(), 0, w.z(), 0, w.x(), w.y();
  return J;
}

}  // namespace

Eigen::Matrix3d followedBy(const Eigen::Matrix3d& first, const Eigen::Matrix3d& second) {
  return first + second + second * first;
}

/// The sums of Preintegration::integrate.
AxesJacobian axesJacobian(const Preintegration& imu, const Eigen::Vector3d& mean_f) {
  Matrix39 v_by_A = Matrix39::Zero(), p_by_A = v_by_A;
  Matrix36 theta_by_G = Matrix36::Zero(), v_by_G = theta_by_G, p_by_G = theta_by_G;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d R0 = Eigen::Matrix3d::Identity();
  for (std::size_t i = 1; i < imu.samples().size(); ++i) {
    const ImuSample &s0 = imu.samples()[i - 1], &s1 = imu.samples()[i];
    const double dt = 1e-9 * static_cast<double>(s1.t_ns - s0.t_ns);
    const Eigen::Vector3d w = 0.5 * (s0.gyro + s1.gyro), phi = (w - imu.bias().gyro) * dt;
    const Eigen::Quaterniond step = expRotation(phi);
    q = (q * step).normalized();
    const Eigen::Matrix3d R1 = q.toRotationMatrix();
    const Matrix39 a_by_A = 0.5 * (byAxes(R0, s0.accel - mean_f) + byAxes(R1, s1.accel - mean_f));
    p_by_A += v_by_A * dt + 0.5 * dt * dt * a_by_A;
    v_by_A += dt * a_by_A;

    const Matrix36 theta0_by_G = theta_by_G;
    theta_by_G = step.toRotationMatrix().transpose() * theta0_by_G + rightJacobian(phi) * dt * bySymmetric(w);
    const Matrix36 a_by_G = -0.5 * (R0 * skew(s0.accel - imu.bias().accel) * theta0_by_G +
                                    R1 * skew(s1.accel - imu.bias().accel) * theta_by_G);
    p_by_G += v_by_G * dt + 0.5 * dt * dt * a_by_G;
    v_by_G += dt * a_by_G;
    R0 = R1;
  }
  AxesJacobian J = AxesJacobian::Zero();
  J.topRightCorner<3, 6>() = theta_by_G;
  J.bottomLeftCorner<6, 9>() << v_by_A, p_by_A;
  J.bottomRightCorner<6, 6>() << v_by_G, p_by_G;
  return J;
}

ImuBatch withAxes(ImuBatch samples, const ImuAxes& axes) {
  for (ImuSample& sample : samples) {
    sample.accel += axes.A * (sample.accel - axes.mean_f);
    sample.gyro += axes.G * sample.gyro;
  }
  return samples;
}

Preintegration withAxes(const Preintegration& imu, const ImuAxes& axes) {
  if (axes.A.isZero(0) && axes.G.isZero(0)) return imu;
  Preintegration corrected(imu.bias(), imu.noise(), imu.gravity_m_s2());
  corrected.append(withAxes(imu.samples(), axes));
  if (imu.stampSigma() > 0) corrected.setStampNoise(imu.stampSigma(), imu.stampCovariance());
  return corrected;
}

}  // namespace lintel
