// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/ImuAxes.h"

namespace lintel {

Eigen::Matrix3d followedBy(const Eigen::Matrix3d& first, const Eigen::Matrix3d& second) {
  return first + second + second * first;
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
