// SPDX-License-Identifier: BSD-3-Clause
#include "PointMerging.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "SpatialIndex.h"

namespace lintel {

namespace {

constexpr double kCell_m = 0.1;

bool shareKeyframe(const PointRecord& a, const PointRecord& b) {
  for (auto i = a.views.begin(), j = b.views.begin(); i != a.views.end() && j != b.views.end();) {
    if (i->keyframe == j->keyframe) return true;
    i->keyframe < j->keyframe ? ++i : ++j;
  }
  return false;
}

struct Candidate {
  double distance_m = 0;
  std::size_t a = 0, b = 0;
  bool operator<(const Candidate& o) const { return std::tie(distance_m, a, b) < std::tie(o.distance_m, o.a, o.b); }
};

/// Whether the position of one is where the other was seen, in pixels: as a first look.
bool projectsOnto(const KeyframeCameras& cameras, const PointRecord& a, const PointRecord& b, double most_px) {
  const auto n = std::count_if(b.views.begin(), b.views.end(), [](const PointView& v) { return v.inlier; });
  const double most = most_px * static_cast<double>(n);
  double sum = 0;
  for (auto v = b.views.begin(); v != b.views.end() && sum <= most; ++v)
    if (v->inlier) sum += std::min(viewError(cameras, a.p_w, *v), 100.0);
  return n > 0 && sum <= most;
}

}  // namespace

int mergePoints(const KeyframeCameras& cameras, const PointFitParams& fit, const MergeParams& params,
                std::vector<PointRecord>& points) {
  SpatialIndex index(kCell_m);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].known) index.add(i, points[i].p_w);
  std::vector<Candidate> candidates;
  for (const auto& [a, b] : index.pairs()) candidates.push_back({(points[a].p_w - points[b].p_w).norm(), a, b});
  std::sort(candidates.begin(), candidates.end());

  std::vector<std::size_t> roots(points.size());
  std::iota(roots.begin(), roots.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (roots[i] != i) i = roots[i];
    return i;
  };
  int merged = 0;
  for (const Candidate& candidate : candidates) {
    const std::size_t a = std::min(root(candidate.a), root(candidate.b)),
                      b = std::max(root(candidate.a), root(candidate.b));
    if (a == b || shareKeyframe(points[a], points[b])) continue;
    const double most_px = 3 * params.point_max_error_px;
    if (!projectsOnto(cameras, points[a], points[b], most_px) || !projectsOnto(cameras, points[b], points[a], most_px))
      continue;
    PointRecord joint = points[a];
    joint.id = std::min(points[a].id, points[b].id);
    joint.views.clear();
    std::merge(points[a].views.begin(), points[a].views.end(), points[b].views.begin(), points[b].views.end(),
               std::back_inserter(joint.views),
               [](const PointView& x, const PointView& y) { return x.keyframe < y.keyframe; });
    const double alone = std::max(points[a].error_px, points[b].error_px);
    if (!fitPoint(cameras, fit, joint) || joint.error_px > std::min(params.point_max_error_px, 1.3 * alone + 0.3) ||
        std::any_of(joint.views.begin(), joint.views.end(), [](const PointView& v) { return !v.inlier; }))
      continue;
    points[a] = std::move(joint);
    points[b] = {};
    roots[b] = a;
    ++merged;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (roots[i] != i) continue;
    if (kept != i) points[kept] = std::move(points[i]);
    ++kept;
  }
  points.resize(kept);
  return merged;
}

}  // namespace lintel
