// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace lintel {

/// The line residual [Lim2021, Bartoli2005] on the normalised plane, whatever the parameters of the line: distances of
/// two observed end points x to the projected infinite line l (its moment about the camera, in the camera's axes),
///   r_k = weight x_k^T l / |l_xy|,   d r_k / d l = weight / |l_xy| (x_k - distance (l_x, l_y, 0) / |l_xy|)^T
struct LineDistances {
  Eigen::Vector2d residual;
  Eigen::RowVector3d d_l[2];  ///< d residual[k] / d l
  Eigen::Vector2d normal;     ///< of the projected line, unit

  /// `ends`: both (x/z, y/z, 1).
  LineDistances(const Eigen::Vector3d ends[2], const Eigen::Vector3d& l, double weight) {
    const double size = std::max(l.head<2>().norm(), 1e-12);
    normal = l.head<2>() / size;
    for (int k = 0; k < 2; ++k) {
      const double distance = ends[k].dot(l) / size;
      residual[k] = weight * distance;
      d_l[k] = weight / size * (ends[k].transpose() - distance * Eigen::RowVector3d(normal.x(), normal.y(), 0));
    }
  }
};

}  // namespace lintel
