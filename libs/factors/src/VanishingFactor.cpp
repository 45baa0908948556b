// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/VanishingFactor.h"

#include <algorithm>

#include "lintel/geometry/Rotation.h"

namespace lintel {

void VanishingFactor::linearise(const CameraView& view, const double* correction, const double* const& direction,
                                bool jacobians, DirectionLinearisation& out) const {
  const Eigen::Vector3d start = start_.corrected(correction), end = end_.corrected(correction);
  const Eigen::Vector3d cross = start.cross(end), d_c = view.R_c_w * Eigen::Vector3d::Map(direction);
  const double norm = std::max(cross.norm(), 1e-12);
  const Eigen::Vector3d n = cross / norm;
  out.residual[0] = weight_ * n.dot(d_c);
  if (!jacobians) return;
  out.d_camera << 0, 0, 0, weight_ * n.transpose() * skew(d_c);             // R_c_w <- Exp(-dtheta) R_c_w
  const Eigen::Vector3d d_cross = weight_ / norm * (d_c - n.dot(d_c) * n);  // d r / d cross
  const Eigen::Vector3d d_start = end.cross(d_cross), d_end = d_cross.cross(start);
  out.d_correction << start_.alongJacobian(d_start) + end_.alongJacobian(d_end), 0;
  out.d_target = weight_ * n.transpose() * view.R_c_w;
}

}  // namespace lintel
