// SPDX-License-Identifier: BSD-3-Clause
#include "window/OutlierRejection.h"

#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "window/LastingPoints.h"

namespace lintel {

int rejectOutliers(SlidingWindow& window, const LandmarkParams& params) {
  int rejected = 0;
  const std::set<BlockKey> in_priors = pointsInPriors(window);  // lastingPoints() judges them
  const CameraPoses poses(window);
  for (auto& [id, track] : window.points) {
    if (!track.triangulated || in_priors.count({BlockKey::kPoint, id}) > 0) continue;
    if (reprojectionError(poses, track) <= params.point_max_error_px) continue;
    // the newest sighting may be right: the track starts anew from there
    track.sightings.erase(track.sightings.begin(), track.sightings.end() - 1);
    track.former.clear();
    track.triangulated = false;
    ++rejected;
  }
  for (auto& [id, track] : window.lines) {
    if (!track.triangulated || !track.distance_known || track.sightings.empty()) continue;
    const double error = lineError(poses, track);
    if (error <= params.line_max_error_px) continue;
    if (track.degenerate()) continue;  // a bad estimate, not a bad track: made anew, from its group or by itself
    track.sightings.erase(track.sightings.begin(), track.sightings.end() - 1);
    track.former.clear();
    track.triangulated = false;
    track.verdict = LineVerdict::kNone;
    track.group = 0;
    track.best.reset();
    ++rejected;
  }
  return rejected;
}

}  // namespace lintel
