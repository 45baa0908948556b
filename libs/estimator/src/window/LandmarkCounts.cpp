// SPDX-License-Identifier: BSD-3-Clause
#include "window/LandmarkCounts.h"

#include "landmarks/LineDegeneracy.h"

namespace lintel {

void countLandmarks(const SlidingWindow& window, const DegeneracyParams& params, WindowUpdate& update) {
  const FrameId newest = window.frames.back().id;
  for (const auto& [id, track] : window.points) update.points_used += track.triangulated;
  for (const auto& [id, track] : window.lines) {
    const bool enters = entersProblem(track, params);
    update.lines_tracked += !track.sightings.empty() && track.sightings.back().frame == newest;
    update.lines_placed += track.triangulated;
    update.lines_used += enters;
    update.lines_constrained += enters && track.group != 0;
    update.lines_degenerate += track.triangulated && track.degenerate();
    update.lines_through_epipole += track.verdict == LineVerdict::kThroughEpipole;
    update.lines_direction_unknown += track.verdict == LineVerdict::kDirectionUnknown;
    update.lines_distance_unknown += track.verdict == LineVerdict::kDistanceUnknown;
  }
}

}  // namespace lintel
