// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include "lintel/simulation/EurocWriter.h"

namespace lintel {

namespace {
constexpr double kParallel_rad = 0.2 * 3.141592653589793 / 180;
constexpr std::size_t kFewest = 6;
}  // namespace

std::vector<int> directionGroups(const std::vector<SceneLine>& lines) {
  std::vector<std::vector<std::size_t>> families;  // the first member stands for all
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Eigen::Vector3d d = lines[i].segment_w.direction();
    const auto family = std::find_if(families.begin(), families.end(), [&](const std::vector<std::size_t>& members) {
      return lineAngle(d, lines[members.front()].segment_w.direction()) < kParallel_rad;
    });
    if (family == families.end()) {
      families.push_back({i});
    } else {
      family->push_back(i);
    }
  }
  std::stable_sort(families.begin(), families.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<int> groups(lines.size(), -1);
  for (std::size_t g = 0; g < families.size() && families[g].size() >= kFewest; ++g) {
    for (const std::size_t i : families[g]) groups[i] = static_cast<int>(g);
  }
  return groups;
}

}  // namespace lintel
