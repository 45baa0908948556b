// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lintel {

/// How the camera turned between two frames, by what its images show alone.
struct CameraTurn {
  std::int64_t from_ns = 0, to_ns = 0;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< Exp(rotation) = R_c0_c1, axes of the camera [rad]
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();     ///< its standard deviations

  bool known() const { return to_ns > from_ns; }  ///< false: the images do not tell
};

}  // namespace lintel
