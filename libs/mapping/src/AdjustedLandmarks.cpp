// SPDX-License-Identifier: BSD-3-Clause
#include "AdjustedLandmarks.h"

#include <algorithm>

#include "Evidence.h"

namespace lintel {

namespace {

/// Where there are so many landmarks that each could have too few views, every n-th takes part, and the points that
/// were seen again.
void takeFewer(const MapMaterial& material, const RefinementParams& params, AdjustedLandmarks& used) {
  const auto count = static_cast<std::size_t>(std::count(used.points.begin(), used.points.end(), true) +
                                              std::count(used.lines.begin(), used.lines.end(), true));
  const std::size_t n =
      1 + count * static_cast<std::size_t>(params.min_views) / static_cast<std::size_t>(params.most_residuals);
  std::size_t at = 0;
  for (std::size_t i = 0; i < used.points.size(); ++i)
    if (used.points[i] && material.points[i].extra_sigma_px == 0) used.points[i] = at++ % n == 0;
  for (std::size_t i = 0; i < used.lines.size(); ++i)
    if (used.lines[i]) used.lines[i] = at++ % n == 0;
}

/// The most views of a landmark, so that all together keep to `most_residuals`. Views of landmarks grow with the time
/// at a place, what they tell about it hardly.
std::size_t mostViews(const MapMaterial& material, const RefinementParams& params, const AdjustedLandmarks& used) {
  const auto most_views = static_cast<std::size_t>(params.max_views);
  std::vector<std::size_t> views;
  const auto add = [&](int inliers) {
    const auto n = static_cast<std::size_t>(inliers);
    views.push_back(most_views == 0 ? n : std::min(n, most_views));
  };
  for (std::size_t i = 0; i < material.points.size(); ++i)
    if (used.points[i]) add(inliersOf(material.points[i]));
  for (std::size_t i = 0; i < material.lines.size(); ++i)
    if (used.lines[i]) add(inliersOf(material.lines[i]));
  std::sort(views.begin(), views.end());
  auto left = static_cast<std::size_t>(params.most_residuals);
  for (std::size_t n = 0; n < views.size(); ++n) {  // the shortest tracks have all, the others share what is left
    const std::size_t share = left / (views.size() - n);
    if (views[n] > share) return std::max(share, static_cast<std::size_t>(params.min_views));
    left -= views[n];
  }
  return most_views;
}

}  // namespace

AdjustedLandmarks landmarksToAdjust(const MapMaterial& material, const RefinementParams& params) {
  AdjustedLandmarks used;
  for (const PointRecord& p : material.points) used.points.push_back(p.known && inliersOf(p) >= params.min_views);
  for (const LineRecord& l : material.lines)
    used.lines.push_back(params.lines && l.known && keyframesOf(l) >= params.min_views &&
                         l.estimate.sigmaDirection() <= params.line_max_sigma_direction_rad &&
                         l.estimate.sigmaPosition(0) <= params.line_max_relative_sigma * l.distance_m);
  used.most_views = static_cast<std::size_t>(params.max_views);
  if (params.most_residuals == 0) return used;
  takeFewer(material, params, used);
  used.most_views = mostViews(material, params, used);
  return used;
}

}  // namespace lintel
