// SPDX-License-Identifier: BSD-3-Clause
#include "SpatialIndex.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lintel {

bool SpatialIndex::Entry::operator<(const Entry& o) const {
  return std::tie(x, y, z, thing) < std::tie(o.x, o.y, o.z, o.thing);
}

void SpatialIndex::add(std::size_t thing, const Eigen::Vector3d& p_w) {
  constexpr double kFarthest = 1e15;  // beyond: no cube has a number
  const Eigen::Vector3d c = (p_w / cell_m_).array().floor();
  if (!c.allFinite() || c.cwiseAbs().maxCoeff() > kFarthest) return;
  entries_.push_back(
      {static_cast<std::int64_t>(c.x()), static_cast<std::int64_t>(c.y()), static_cast<std::int64_t>(c.z()), thing});
}

void SpatialIndex::eachPair(const std::function<void(std::size_t, std::size_t)>& take) const {
  std::vector<Entry> sorted = entries_;
  std::sort(sorted.begin(), sorted.end());
  const auto same = [](const Entry& a, const Entry& b) { return !(a < b) && !(b < a); };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  for (const Entry& e : sorted)
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        // the three cubes of a column follow each other in the order
        const Entry from{e.x + dx, e.y + dy, e.z - 1, 0};
        for (auto it = std::lower_bound(sorted.begin(), sorted.end(), from);
             it != sorted.end() && it->x == from.x && it->y == from.y && it->z <= e.z + 1; ++it)
          if (e.thing < it->thing) take(e.thing, it->thing);
      }
}

std::vector<std::pair<std::size_t, std::size_t>> SpatialIndex::pairs() const {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  eachPair([&result](std::size_t a, std::size_t b) { result.emplace_back(a, b); });
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace lintel
