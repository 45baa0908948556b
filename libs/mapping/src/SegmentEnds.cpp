// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/SegmentEnds.h"

#include <algorithm>
#include <cmath>

namespace lintel {

std::optional<std::pair<double, double>> coveredStretch(const std::vector<std::pair<double, double>>& intervals,
                                                        double share) {
  const int needed = std::max(2, static_cast<int>(std::ceil(share * static_cast<double>(intervals.size()))));
  std::vector<std::pair<double, int>> events;  // place, +1 where an interval begins and -1 where it ends
  for (const auto& [a, b] : intervals) {
    events.emplace_back(std::min(a, b), +1);
    events.emplace_back(std::max(a, b), -1);
  }
  std::sort(events.begin(), events.end(),
            [](const auto& x, const auto& y) { return x.first != y.first ? x.first < y.first : x.second > y.second; });
  std::optional<double> from;
  double to = 0;
  int depth = 0;
  for (const auto& [place, change] : events) {
    const int before = depth;
    depth += change;
    if (before < needed && depth >= needed && !from) from = place;
    if (before >= needed && depth < needed) to = place;
  }
  if (!from || !(to > *from)) return std::nullopt;
  return std::make_pair(*from, to);
}

}  // namespace lintel
