// SPDX-License-Identifier: BSD-3-Clause
#include "LineExtent.h"

#include <algorithm>
#include <map>

#include "LineFitting.h"
#include "lintel/mapping/SegmentEnds.h"

namespace lintel {

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

int inliersOf(const LineRecord& line) {
  return static_cast<int>(
      std::count_if(line.views.begin(), line.views.end(), [](const LineView& v) { return v.inlier; }));
}

int keyframesOf(const LineRecord& line) {
  std::vector<FrameId> ids;
  for (const LineView& v : line.views)
    if (v.inlier) ids.push_back(v.keyframe);
  std::sort(ids.begin(), ids.end());
  return static_cast<int>(std::unique(ids.begin(), ids.end()) - ids.begin());
}

}  // namespace lintel
