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
  std::vector<Entry> by_cube = entries_;
  std::sort(by_cube.begin(), by_cube.end());
  const auto same = [](const Entry& a, const Entry& b) { return !(a < b) && !(b < a); };
  by_cube.erase(std::unique(by_cube.begin(), by_cube.end(), same), by_cube.end());
  std::vector<Entry> by_thing = by_cube;
  std::stable_sort(by_thing.begin(), by_thing.end(), [](const Entry& a, const Entry& b) { return a.thing < b.thing; });
  std::vector<std::size_t> met(by_thing.empty() ? 0 : by_thing.back().thing + 1, 0);  // after which thing, from 1 on
  for (const Entry& e : by_thing)
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        // the three cubes of a column follow each other in the order
        const Entry from{e.x + dx, e.y + dy, e.z - 1, 0};
        for (auto it = std::lower_bound(by_cube.begin(), by_cube.end(), from);
             it != by_cube.end() && it->x == from.x && it->y == from.y && it->z <= e.z + 1; ++it)
          if (e.thing < it->thing && met[it->thing] != e.thing + 1) {
            met[it->thing] = e.thing + 1;
            take(e.thing, it->thing);
          }
      }
}

}  // namespace lintel
