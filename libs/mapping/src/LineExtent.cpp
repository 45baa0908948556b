// SPDX-License-Identifier: BSD-3-Clause
#include "LineExtent.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "LineViews.h"

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

std::optional<std::pair<double, double>> seenStretch(const KeyframeCameras& cameras, const LineRecord& line,
                                                     double share) {
  std::map<TrackId, std::vector<std::pair<double, double>>> intervals;
  for (const LineView& v : line.views) {
    std::pair<double, double> stretch;
    if (v.inlier && viewStretch(cameras, line.estimate, v, stretch)) intervals[v.track].push_back(stretch);
  }
  std::optional<std::pair<double, double>> whole;
  for (const auto& [track, pieces] : intervals) {
    const auto piece = coveredStretch(pieces, share);
    if (!piece) continue;
    whole =
        whole ? std::make_pair(std::min(whole->first, piece->first), std::max(whole->second, piece->second)) : *piece;
  }
  return whole;
}

Segment3 segmentOf(const KeyframeCameras& cameras, const LineRecord& line, const std::pair<double, double>& stretch) {
  const auto at = [&](double along) -> Eigen::Vector3d {
    return line.estimate.middle_w + along * line.estimate.direction_w;
  };
  bool forward = true;
  for (const LineView& v : line.views) {
    std::pair<double, double> seen;
    if (!v.inlier || !viewStretch(cameras, line.estimate, v, seen)) continue;
    forward = seen.second >= seen.first;
    break;
  }
  return forward ? Segment3{at(stretch.first), at(stretch.second)} : Segment3{at(stretch.second), at(stretch.first)};
}

}  // namespace lintel
