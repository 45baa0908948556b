// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/geometry/Camera.h"

namespace lintel {

/// The image of a point before focal length and principal point, with its derivatives.
struct LensImage {
  Eigen::Vector2d position;
  Eigen::Matrix<double, 2, 3> by_point;
  Eigen::Matrix2d by_coefficients;  ///< the first two
  bool valid = true;                ///< the model holds at the point
};

/// Of the models that are wide.
LensImage fisheyeImage(const Camera& camera, const Eigen::Vector3d& p_c);

/// Its position alone.
Eigen::Vector2d fisheyePosition(const Camera& camera, const Eigen::Vector3d& p_c);

/// The unit ray of a position in that image; false where there is none.
bool fisheyeRay(const Camera& camera, const Eigen::Vector2d& position, Eigen::Vector3d& ray);

}  // namespace lintel
