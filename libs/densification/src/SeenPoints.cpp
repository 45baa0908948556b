// SPDX-License-Identifier: BSD-3-Clause
#include "SeenPoints.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace lintel {

namespace {

constexpr double kAround_rad = 0.1;  // between a place and the points beside it
constexpr std::size_t kNearest = 5;  // of the points around
constexpr std::size_t kLeastPoints = 3;
constexpr double kClearlyFarther = 1.3;  // than the farthest of these: points lie on edges and on what is behind them

}  // namespace

SeenPoints::SeenPoints(const MapMaterial& material, const std::vector<SegmentView>& views) : by_view_(views.size()) {
  std::unordered_map<FrameId, std::size_t> place;
  for (std::size_t v = 0; v < views.size(); ++v) {
    place.emplace(views[v].keyframe, v);
    by_view_[v].p_w_c = views[v].p_w_c;
  }
  for (const PointRecord& point : material.points) {
    if (!point.known) continue;
    std::vector<std::size_t> by;
    for (const PointView& view : point.views) {
      const auto found = place.find(view.keyframe);
      if (!view.inlier || found == place.end()) continue;
      by.push_back(found->second);
      Points& points = by_view_[found->second];
      const Eigen::Vector3d ray = point.p_w - points.p_w_c;
      points.rays_w.push_back(ray.normalized());
      points.distances_m.push_back(ray.norm());
    }
    views_by_point_.push_back(std::move(by));
  }
}

std::optional<bool> SeenPoints::isBehind(std::size_t view, const Eigen::Vector3d& p_w) const {
  const Points& points = by_view_[view];
  const Eigen::Vector3d ray = p_w - points.p_w_c;
  const double distance = ray.norm();
  const double least_cosine = std::cos(kAround_rad);
  std::vector<std::pair<double, double>> around;  // cosine, negative: nearest first; distance
  for (std::size_t i = 0; i < points.rays_w.size(); ++i)
    if (const double cosine = points.rays_w[i].dot(ray) / distance; cosine > least_cosine)
      around.emplace_back(-cosine, points.distances_m[i]);
  if (around.size() < kLeastPoints) return std::nullopt;
  std::sort(around.begin(), around.end());
  around.resize(std::min(around.size(), kNearest));
  const auto farthest =
      std::max_element(around.begin(), around.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return distance > kClearlyFarther * farthest->second;
}

}  // namespace lintel
