// SPDX-License-Identifier: BSD-3-Clause
#include "PlanePoints.h"

#include <algorithm>
#include <cmath>

namespace lintel {

namespace {

constexpr double kPointCube_m = 0.5;        // points farther from all lines of a plane than one to two are not in it
constexpr double kMostPlaneSamples = 2000;  // of very long lines
constexpr double kPointMost_m = 0.02;       // from the plane, and
constexpr double kPointSigmas = 2;
constexpr double kPointFlatness_m = 0.004;
constexpr double kFarthestPoint_m = 1e15;  // beyond: no cube has a number

}  // namespace

PlanePoints::Cube PlanePoints::cubeOf(const Eigen::Vector3d& p_w) {
  const Eigen::Vector3d c = (p_w / kPointCube_m).array().floor();
  return {static_cast<std::int64_t>(c.x()), static_cast<std::int64_t>(c.y()), static_cast<std::int64_t>(c.z())};
}

void PlanePoints::addLine(std::size_t plane, const Segment3& segment_w) {
  const double steps = std::min(kMostPlaneSamples, 1 + std::floor(segment_w.length() / kPointCube_m));
  for (int k = 0; k <= static_cast<int>(steps); ++k)
    entries_.emplace_back(cubeOf(segment_w.start + k / steps * (segment_w.end - segment_w.start)), plane);
}

std::vector<std::size_t> PlanePoints::planesNear(const Eigen::Vector3d& p_w) const {
  std::vector<std::size_t> near;
  const auto [x, y, z] = cubeOf(p_w);
  for (std::int64_t dx = -1; dx <= 1; ++dx)
    for (std::int64_t dy = -1; dy <= 1; ++dy)
      for (auto it = std::lower_bound(entries_.begin(), entries_.end(),
                                      std::make_pair(Cube{x + dx, y + dy, z - 1}, std::size_t{0}));
           it != entries_.end() && it->first <= Cube{x + dx, y + dy, z + 1}; ++it)
        near.push_back(it->second);
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

void PlanePoints::assign(const LineMap& map, std::vector<MapPlane>& planes) {
  std::sort(entries_.begin(), entries_.end());
  entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  for (const MapPoint& point : map.points) {
    if (!(point.p_w.cwiseAbs().maxCoeff() < kFarthestPoint_m)) continue;
    const double most_m = std::min(kPointMost_m, kPointSigmas * std::hypot(point.sigma_distance_m, kPointFlatness_m));
    for (const std::size_t p : planesNear(point.p_w))
      if (std::abs(planes[p].normal_w.dot(point.p_w) - planes[p].offset_m) <= most_m)
        planes[p].points.push_back(point.id);
  }
}

}  // namespace lintel
