// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// Which points lie in planes: near a line of the plane, and as near to the plane as their sigmas allow.
class PlanePoints {
 public:
  void addLine(std::size_t plane, const Segment3& segment_w);

  /// Sets the points of the planes.
  void assign(const LineMap& map, std::vector<MapPlane>& planes);

 private:
  using Cube = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

  static Cube cubeOf(const Eigen::Vector3d& p_w);
  std::vector<std::size_t> planesNear(const Eigen::Vector3d& p_w) const;

  std::vector<std::pair<Cube, std::size_t>> entries_;  // cubes that a plane's lines pass
};

}  // namespace lintel
