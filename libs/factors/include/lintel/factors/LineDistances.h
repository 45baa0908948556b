// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace lintel {

/// The line residual [Lim2021, Bartoli2005], whatever the parameters of the line: distances of the rays x of two
/// observed end points from the plane through camera and line, with its normal l (the line's moment about the camera,
/// in the camera's axes). Of lenses that are not wide that is the distance to the projected line on the plane z = 1,
///   r_k = weight x_k^T l / |l_xy|,   d r_k / d l = weight / |l_xy| (x_k - distance (l_x, l_y, 0) / |l_xy|)^T
/// and of wide ones, whose rays have unit length, the sine of the distance from the great circle: |l| for |l_xy|, and l
/// for (l_x, l_y, 0). Nearer to the camera than `least` |l_xy| stays at `least`: a line through the camera has no
/// image, and derivatives would grow without bounds.
struct LineDistances {
  Eigen::Vector2d residual;
  Eigen::RowVector3d d_l[2];  ///< d residual[k] / d l
  Eigen::Vector3d normal;     ///< of the projected line or of the great circle, unit unless it is near
  bool near;                  ///< at `least`

  LineDistances(const Eigen::Vector3d ends[2], const Eigen::Vector3d& l, double weight, bool wide,
                double least = 1e-12) {
    const double seen = wide ? l.norm() : l.head<2>().norm(), size = std::max(seen, least);
    near = seen < least;
    normal = l / size;
    if (!wide) normal.z() = 0;
    for (int k = 0; k < 2; ++k) {
      const double distance = ends[k].dot(l) / size;
      residual[k] = weight * distance;
      d_l[k] = weight / size * (ends[k] - (near ? 0 : distance) * normal).transpose();
    }
  }
};

}  // namespace lintel
