// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ImageLine.h"

namespace lintel {

struct RobustLine {
  ImageLine line;            ///< through the first and last inlier
  std::vector<char> inlier;  ///< per point
  int inliers = 0;
};

/// The line that most points lie on (every pair is tried: meant for about ten points), refitted by total least squares.
/// Empty with fewer than 3 inliers or less than half of the points.
std::optional<RobustLine> fitRobustLine(const std::vector<Eigen::Vector2d>& points, double tolerance_px);

}  // namespace lintel
