// SPDX-License-Identifier: BSD-3-Clause
#include "PointMerging.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "Evidence.h"
#include "MergedRecords.h"
#include "SpatialIndex.h"

namespace lintel {

namespace {

constexpr double kPointCell_m = 0.1;  // points nearer than this are always compared

struct PointPair {
  double distance_m = 0;
  std::size_t a = 0, b = 0;
  bool operator<(const PointPair& o) const { return std::tie(distance_m, a, b) < std::tie(o.distance_m, o.a, o.b); }
};

/// Whether the position of one is where the other was seen, in pixels: as a first look.
bool projectsOnto(const KeyframeCameras& cameras, const PointRecord& a, const PointRecord& b, double most_px) {
  const int n = inliersOf(b);
  const double most = most_px * static_cast<double>(n);
  double sum = 0;
  for (auto v = b.views.begin(); v != b.views.end() && sum <= most; ++v)
    if (v->inlier) sum += std::min(viewError(cameras, a.p_w, *v), 100.0);
  return n > 0 && sum <= most;
}

}  // namespace

int mergePoints(const KeyframeCameras& cameras, const PointFitParams& fit, const MergeParams& params,
                std::vector<PointRecord>& points) {
  SpatialIndex index(kPointCell_m);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].known) index.add(i, points[i].p_w);
  const double most_px = 3 * params.point_max_error_px;
  const auto alike = [&](std::size_t a, std::size_t b) {
    return projectsOnto(cameras, points[a], points[b], most_px) && projectsOnto(cameras, points[b], points[a], most_px);
  };
  const auto jointPoint = [&](std::size_t a, std::size_t b) -> std::optional<PointRecord> {
    if (shareKeyframe(points[a], points[b]) || !alike(a, b)) return std::nullopt;
    PointRecord joint = points[a];
    joint.id = std::min(points[a].id, points[b].id);
    joint.views = mergedViews(points[a].views, points[b].views);
    joint.joined.push_back(std::max(points[a].id, points[b].id));
    joint.joined.insert(joint.joined.end(), points[b].joined.begin(), points[b].joined.end());
    const double separate = std::max(points[a].error_px, points[b].error_px);
    if (!fitPoint(cameras, fit, joint) || joint.error_px > std::min(params.point_max_error_px, 1.3 * separate + 0.3) ||
        std::any_of(joint.views.begin(), joint.views.end(), [](const PointView& v) { return !v.inlier; }))
      return std::nullopt;
    return joint;
  };
  std::vector<PointPair> candidates;  // a place seen again and again has too many neighbours to keep them all
  index.eachPair([&](std::size_t a, std::size_t b) {
    if (!shareKeyframe(points[a], points[b]) && alike(a, b))
      candidates.push_back({(points[a].p_w - points[b].p_w).norm(), a, b});
  });
  std::sort(candidates.begin(), candidates.end());

  MergedRecords records(points.size());
  PairAnswers refused(records);
  int merged = 0;
  for (const PointPair& candidate : candidates) {
    const std::size_t a = std::min(records.rootOf(candidate.a), records.rootOf(candidate.b)),
                      b = std::max(records.rootOf(candidate.a), records.rootOf(candidate.b));
    if (a == b || refused.isYes(a, b)) continue;
    std::optional<PointRecord> joint = jointPoint(a, b);
    if (!joint) {
      refused.set(a, b, true);
      continue;
    }
    points[a] = std::move(*joint);
    points[b] = {};
    records.join(a, b);
    ++merged;
  }
  records.compact(points);
  return merged;
}

}  // namespace lintel
