// SPDX-License-Identifier: BSD-3-Clause
#include "LineTying.h"

#include "Evidence.h"
#include "LineGroups.h"
#include "LineJudgement.h"
#include "PointsOnLines.h"
#include "lintel/geometry/Segment.h"

namespace lintel {

namespace {

constexpr double kLeastInliers = 0.9;  // share of a line's views that must still agree
constexpr double kSigmas = 3;          // by which a line may be off the group whose direction it has
constexpr double kMoreError_px = 0.3;  // that the tie may add to the mean error

/// Whether the tied line explains the views as well as the free one.
bool viewsAgree(const LineRecord& tied, const LineRecord& free) {
  const int before = free.known ? inliersOf(free) : static_cast<int>(free.views.size());
  return inliersOf(tied) >= kLeastInliers * before && tied.error_px <= (free.known ? free.error_px : 0) + kMoreError_px;
}

/// Ties a line to the group whose direction fits its views best.
bool tieToBest(const KeyframeCameras& cameras, const LineFitParams& fit, const std::vector<MapGroup>& groups,
               const PointsOnLines& points, LineRecord& line) {
  std::optional<LineRecord> best;
  for (const MapGroup& group : groups) {
    LineRecord tied = line;
    tied.known = false;
    tied.tie = LineTie{group.direction_w, sigmaOf(group), points.on(line, group.direction_w)};
    if (!fitLine(cameras, fit, tied) || !viewsAgree(tied, line)) continue;
    if (!best || tied.error_px < best->error_px) best = std::move(tied);
  }
  if (best) line = std::move(*best);
  return best.has_value();
}

}  // namespace

int tieDegenerateLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MapParams& params,
                       const std::vector<MapGroup>& groups, MapMaterial& material) {
  const PointsOnLines points(cameras, material.points);
  int tied = 0;
  for (LineRecord& line : material.lines) {
    if (!line.parallel || line.tie || judgeMapLine(params, cameras, line).state == LineState::kKnown) continue;
    tied += tieToBest(cameras, fit, groups, points, line);
  }
  return tied;
}

int alignToGroups(const KeyframeCameras& cameras, const LineFitParams& fit, const MapParams& params,
                  const std::vector<MapGroup>& groups, MapMaterial& material) {
  int aligned = 0;
  for (LineRecord& line : material.lines) {
    if (line.tie || judgeMapLine(params, cameras, line).state != LineState::kKnown) continue;
    const MapGroup* nearest = nullptr;
    double least = params.groups.max_angle_rad;
    for (const MapGroup& group : groups) {
      const double angle = lineAngle(group.direction_w, line.estimate.direction_w);
      if (angle > std::min(least, kSigmas * std::hypot(sigmaOf(group), line.estimate.sigmaDirection()))) continue;
      nearest = &group, least = angle;
    }
    if (!nearest) continue;
    LineRecord tied = line;
    tied.tie = LineTie{nearest->direction_w, sigmaOf(*nearest), {}};
    if (!fitLine(cameras, fit, tied) || !viewsAgree(tied, line)) continue;
    tied.tie.reset();
    line = std::move(tied);
    ++aligned;
  }
  return aligned;
}

}  // namespace lintel
