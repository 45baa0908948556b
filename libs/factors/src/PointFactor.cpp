// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/PointFactor.h"

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {

void PointFactor::linearise(const CameraView& view, const double* correction, const double* const& point,
                            bool jacobians, PointLinearisation& out) const {
  const Eigen::Vector3d X = Eigen::Vector3d::Map(point);
  const double w = point[3];
  const Camera camera = correctedCamera(camera_, correction);
  const Eigen::Vector3d from_camera_w = origin_w_ - view.p_w_c;
  Eigen::Vector3d g_c = view.R_c_w * (X + w * from_camera_w);  // scaled by w
  if (const double delay_s = row_.delay_s(correction[kReadoutAt]); delay_s != 0)
    g_c -= delay_s * (w * (view.R_c_w * view.d_offset.head<3>()) + view.d_offset.tail<3>().cross(g_c));
  if (!jacobians) {
    out.residual = weight_ * (camera.project(g_c) - px_);
    return;
  }
  PixelJacobians d;  // of the residual
  out.residual = weight_ * (camera.project(g_c, weight_, d) - px_);
  const Eigen::Matrix<double, 2, 3> d_gw = d.point * view.R_c_w;
  out.d_camera.leftCols<3>() = -w * d_gw;
  out.d_camera.rightCols<3>() = d.point * skew(g_c);
  out.d_correction.leftCols<kIntrinsicsSize>() = d.intrinsics;
  out.d_correction.col(kReadoutAt) = row_.share * (out.d_camera * view.d_offset);
  out.d_target.leftCols<3>() = d_gw;
  out.d_target.col(3) = d_gw * from_camera_w;
}

}  // namespace lintel
