// SPDX-License-Identifier: BSD-3-Clause
#include "window/LandmarkCounts.h"

#include <vector>

#include "landmarks/LineDegeneracy.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

void countLandmarks(const SlidingWindow& window, const DegeneracyParams& params, WindowUpdate& update) {
  const WindowFrame& frame = window.frames.back();
  const FrameId newest = frame.id;
  std::vector<double> distances_m;
  for (const auto& [id, track] : window.points)
    if (track.triangulated) distances_m.push_back((window.positionOf(track) - frame.T_w_b().p).norm());
  update.points_used = static_cast<int>(distances_m.size());
  update.points_distance_m = distances_m.empty() ? 0 : upperMedian(distances_m);
  update.lines_tracked = update.lines_placed = update.lines_used = update.lines_constrained = 0;
  update.lines_degenerate = update.lines_through_epipole = 0;
  update.lines_direction_unknown = update.lines_distance_unknown = 0;
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
