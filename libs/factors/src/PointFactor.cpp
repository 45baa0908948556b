// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/PointFactor.h"

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {

void PointFactor::linearise(const CameraView& view, const double* correction, const double* point, bool jacobians,
                            PointLinearisation& out) const {
  const Eigen::Vector3d X = Eigen::Vector3d::Map(point);
  const double w = point[3];
  const PinholeRadtan camera = correctedCamera(camera_, correction);
  const Eigen::Vector3d from_camera_w = origin_w_ - view.p_w_c;
  const Eigen::Vector3d g_c = view.R_c_w * (X + w * from_camera_w);  // scaled by w
  const double z = std::abs(g_c.z()) > 1e-9 ? g_c.z() : 1e-9;
  const Eigen::Vector2d n = g_c.head<2>() / z, distorted = camera.distort(n);
  out.residual =
      weight_ * (Eigen::Vector2d(camera.fx * distorted.x() + camera.cx, camera.fy * distorted.y() + camera.cy) - px_);
  if (!jacobians) return;

  const Eigen::Vector2d focal(weight_ * camera.fx, weight_ * camera.fy);
  Eigen::Matrix<double, 2, 3> d_n;  // d n / d g_c
  d_n << 1 / z, 0, -n.x() / z, 0, 1 / z, -n.y() / z;
  const Eigen::Matrix2d d_distorted = focal.asDiagonal() * camera.distortJacobian(n);
  const Eigen::Matrix<double, 2, 3> d_g = d_distorted * d_n, d_gw = d_g * view.R_c_w;
  out.d_camera.leftCols<3>() = -w * d_gw;
  out.d_camera.rightCols<3>() = d_g * skew(g_c);
  const double r2 = n.squaredNorm();
  out.d_intrinsics << weight_ * distorted.x(), 0, weight_, 0, focal.x() * n.x() * r2, focal.x() * n.x() * r2 * r2, 0,
      weight_ * distorted.y(), 0, weight_, focal.y() * n.y() * r2, focal.y() * n.y() * r2 * r2;
  out.d_target.leftCols<3>() = d_gw;
  out.d_target.col(3) = d_gw * from_camera_w;
}

}  // namespace lintel
