// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/StateBlocks.h"

namespace lintel {

PoseBlock toBlock(const Pose& pose) {
  PoseBlock b;
  b << pose.p, pose.q.coeffs();
  return b;
}

Pose poseFromBlock(const double* b) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(b + 3)), Eigen::Vector3d(b[0], b[1], b[2])};
}

LineBlock toBlock(const OrthonormalLine& line) {
  LineBlock b;
  b << line.U.coeffs(), line.phi;
  return b;
}

OrthonormalLine lineFromBlock(const double* b) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(b)), b[4]};
}

AxesBlock toBlock(const ImuAxes& axes) {
  const Eigen::Matrix3d rows = axes.A.transpose(), &G = axes.G;
  AxesBlock b;
  b << Eigen::Map<const Eigen::Matrix<double, 9, 1>>(rows.data()), G.diagonal(), G(0, 1), G(0, 2), G(1, 2);
  return b;
}

ImuAxes axesFromBlock(const double* b, const Eigen::Vector3d& mean_f) {
  const double* g = b + kGyroAxesAt;
  ImuAxes axes{Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(b), mean_f};
  axes.G << g[0], g[3], g[4], g[3], g[1], g[5], g[4], g[5], g[2];
  return axes;
}

Eigen::Vector3d velocityOf(const double* motion) { return Eigen::Vector3d::Map(motion + kVelocityAt); }
ImuBias biasOf(const double* motion) {
  return {Eigen::Vector3d::Map(motion + kBiasGyroAt), Eigen::Vector3d::Map(motion + kBiasAccelAt)};
}

Eigen::Matrix<double, 4, 3> rotationPlus(const Eigen::Quaterniond& q) {
  Eigen::Matrix<double, 4, 3> M;
  const double h = 0.5;
  M << h * q.w(), -h * q.z(), h * q.y(), h * q.z(), h * q.w(), -h * q.x(), -h * q.y(), h * q.x(), h * q.w(), -h * q.x(),
      -h * q.y(), -h * q.z();
  return M;
}

Eigen::Matrix<double, 3, 4> rotationLift(const Eigen::Quaterniond& q) { return 4.0 * rotationPlus(q).transpose(); }

}  // namespace lintel
