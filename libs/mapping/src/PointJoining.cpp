// SPDX-License-Identifier: BSD-3-Clause
#include "PointJoining.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "Evidence.h"
#include "MergedRecords.h"

namespace lintel {

namespace {

constexpr double kMostViews = 0.9;  // must agree with a joined point

/// Of joins that contradict each other the one with more votes comes first.
std::vector<PointJoin> byVotes(std::vector<PointJoin> joins) {
  std::sort(joins.begin(), joins.end(), [](const PointJoin& x, const PointJoin& y) {
    return std::tie(y.votes, x.a, x.b) < std::tie(x.votes, y.a, y.b);
  });
  return joins;
}

/// Which record holds a track.
std::unordered_map<TrackId, std::size_t> placesOf(const std::vector<PointRecord>& points) {
  std::unordered_map<TrackId, std::size_t> places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    places.emplace(points[i].id, i);
    for (const TrackId track : points[i].joined) places.emplace(track, i);
  }
  return places;
}

/// One point of both, with all their views; empty when no position explains them. `a` and `b` may be joined already.
std::optional<PointRecord> jointPoint(const KeyframeCameras& cameras, const PointFitParams& fit, const PointRecord& a,
                                      const PointRecord& b, double separate_px, double sigma_px) {
  if (!a.known || !b.known || shareKeyframe(a, b)) return std::nullopt;
  PointRecord both = a;
  both.views = mergedViews(a.views, b.views);
  if (!fitPoint(cameras, fit, both) || inliersOf(both) < kMostViews * static_cast<double>(both.views.size()))
    return std::nullopt;
  both.extra_sigma_px = std::max({sigma_px, both.error_px - separate_px, a.extra_sigma_px, b.extra_sigma_px});
  return both;
}

}  // namespace

int joinPoints(const KeyframeCameras& cameras, const PointFitParams& fit, const std::vector<PointJoin>& joins,
               double most_px, double sigma_px, std::vector<PointRecord>& points) {
  if (joins.empty()) return 0;
  PointFitParams generous = fit;
  generous.max_error_px = most_px;
  generous.sigma_px = most_px / 3;
  const std::unordered_map<TrackId, std::size_t> places = placesOf(points);
  std::unordered_map<std::size_t, PointRecord> joint;  // by the place of the first
  const auto pointAt = [&](std::size_t place) -> const PointRecord& {
    const auto found = joint.find(place);
    return found == joint.end() ? points[place] : found->second;
  };
  MergedRecords records(points.size());
  int hold = 0;
  for (const PointJoin& join : byVotes(joins)) {
    const auto first = places.find(join.a), second = places.find(join.b);
    if (first == places.end() || second == places.end()) continue;
    const std::size_t a = records.rootOf(first->second), b = records.rootOf(second->second);
    if (a == b) {
      ++hold;
      continue;
    }
    const double separate_px = std::max(points[a].error_px, points[b].error_px);
    auto both = jointPoint(cameras, generous, pointAt(a), pointAt(b), separate_px, sigma_px);
    if (!both) continue;
    joint[a] = std::move(*both);
    joint.erase(b);
    records.join(a, b);
    ++hold;
  }
  const std::size_t separate = points.size();
  for (std::size_t i = 0; i < separate; ++i)
    if (const auto found = joint.find(i); found != joint.end()) points.push_back(std::move(found->second));
  return hold;
}

}  // namespace lintel
