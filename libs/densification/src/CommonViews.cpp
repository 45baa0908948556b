// SPDX-License-Identifier: BSD-3-Clause
#include "CommonViews.h"

#include <algorithm>

#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

constexpr std::size_t kLeastShared = 8;            // points
constexpr double kLeastShare = 0.1;                // of the points of the view that sees fewer
constexpr double kNearest = 0.4, kFarthest = 2.5;  // of the nearest and farthest points

/// Of `among` so many that each is as far as possible from those before, beginning with `from`.
std::vector<std::size_t> spread(const std::vector<SegmentView>& views, std::size_t from,
                                const std::vector<std::size_t>& among, std::size_t most) {
  std::vector<double> distance(among.size(), 1e300);
  std::vector<std::size_t> chosen;
  std::size_t last = from;
  while (chosen.size() < std::min(most, among.size())) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < among.size(); ++i) {
      if (distance[i] < 0) continue;
      distance[i] = std::min(distance[i], (views[among[i]].p_w_c - views[last].p_w_c).norm());
      if (distance[best] < 0 || distance[i] > distance[best]) best = i;
    }
    last = among[best];
    distance[best] = -1;
    chosen.push_back(last);
  }
  return chosen;
}

}  // namespace

std::vector<CommonViews> findCommonViews(const SeenPoints& points, std::size_t most, std::vector<SegmentView>& views) {
  std::vector<std::vector<std::size_t>> points_of(views.size());
  for (std::size_t i = 0; i < points.viewsByPoint().size(); ++i)
    for (const std::size_t v : points.viewsByPoint()[i]) points_of[v].push_back(i);
  std::vector<CommonViews> common(views.size());
  std::vector<std::size_t> shared(views.size());  // points, with each other view
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::vector<double> distances = points.distances_m(v);
    if (distances.size() < kLeastShared) continue;
    std::sort(distances.begin(), distances.end());
    views[v].near_m = kNearest * distances[distances.size() / 20];
    views[v].far_m = kFarthest * distances[distances.size() * 19 / 20];
    std::fill(shared.begin(), shared.end(), 0);
    for (const std::size_t i : points_of[v])
      for (const std::size_t other : points.viewsByPoint()[i]) ++shared[other];
    std::vector<std::size_t> among;
    for (std::size_t other = 0; other < views.size(); ++other) {
      if (other == v || shared[other] < kLeastShared) continue;
      const auto fewer = static_cast<double>(std::min(distances.size(), points.distances_m(other).size()));
      if (static_cast<double>(shared[other]) >= kLeastShare * fewer) among.push_back(other);
    }
    common[v].chosen = spread(views, v, among, most);
    common[v].all = std::move(among);
    common[v].all.insert(std::lower_bound(common[v].all.begin(), common[v].all.end(), v), v);
  }
  return common;
}

}  // namespace lintel
