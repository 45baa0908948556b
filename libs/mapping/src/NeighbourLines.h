// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// A line of the map about its middle, with what is known of it there.
struct SpatialLine {
  explicit SpatialLine(const MapLine& line);

  Eigen::Vector3d at(double along_m) const { return middle_w + along_m * direction_w; }

  /// Covariance of the position across the line, in the basis `across`, so far from the middle.
  Eigen::Matrix2d covarianceAt(double along_m) const;

  /// Variance of the position along the unit vector `n`.
  double varianceAt(double along_m, const Eigen::Vector3d& n) const;

  Eigen::Vector3d middle_w, direction_w;
  double half_m;
  Eigen::Matrix<double, 3, 2> across;  ///< tangentBasis(direction_w)
  Eigen::Matrix4d covariance;          ///< as in MapLine; of one without: by its sigmas
};

/// Lines that come nearer to a line than 0.3 m: places, ascending.
using LineNeighbours = std::vector<std::size_t>;
std::vector<LineNeighbours> neighboursOf(const std::vector<SpatialLine>& lines);

/// Where two infinite lines come nearest to each other.
struct Approach {
  double along_a_m = 0, along_b_m = 0;  ///< from the lines' middles
  double gap_m = 0;
  Eigen::Vector3d normal_w = Eigen::Vector3d::Zero();  ///< unit, across both
};

/// Empty when both are nearly parallel: less than 20 degrees apart.
bool approachOf(const SpatialLine& a, const SpatialLine& b, Approach& approach);

}  // namespace lintel
