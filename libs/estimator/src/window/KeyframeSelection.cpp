// SPDX-License-Identifier: BSD-3-Clause
#include "window/KeyframeSelection.h"

#include <algorithm>

namespace lintel {
namespace {

constexpr double kLongRest_s = 0.5;  // shorter: the IMU alone joins the frames before and after it well

template <class Tracks>
int seenIn(const Tracks& tracks, FrameId frame) {
  return static_cast<int>(std::count_if(tracks.begin(), tracks.end(), [frame](const auto& entry) {
    return !entry.second.sightings.empty() && entry.second.sightings.back().frame == frame;
  }));
}

}  // namespace

bool secondNewestIsKeyframe(const SlidingWindow& window, const EstimatorParams& params) {
  const std::size_t n = window.frames.size();
  if (n < 3) return true;
  const WindowFrame &before = window.frames[n - 3], &candidate = window.frames[n - 2];
  const double interval_s = 1e-9 * static_cast<double>(candidate.t_ns - before.t_ns);
  if (interval_s > params.max_keyframe_interval_s) return true;
  // The first frame of a rest stays, as those after it have not moved since; so does the last one, as what moves then
  // starts with its zero velocity.
  const WindowFrame& newest = window.frames[n - 1];
  if (newest.still && !candidate.still) return true;
  if (candidate.at_rest && !newest.at_rest && interval_s > kLongRest_s) return true;
  double sum = 0;
  int shared = 0;
  for (const auto& [id, track] : window.points) {
    const PointSighting *a = nullptr, *b = nullptr;
    for (const PointSighting& s : track.sightings) {
      if (s.frame == before.id) a = &s;
      if (s.frame == candidate.id) b = &s;
    }
    if (!a || !b) continue;
    sum += (a->observation.ray - b->observation.ray).norm();
    ++shared;
  }
  if (shared < params.keyframe_min_tracked) return true;
  return sum / shared * window.camera().meanFocal() >= params.keyframe_parallax_px;
}

int pointsInNewest(const SlidingWindow& window) { return seenIn(window.points, window.frames.back().id); }
int linesInNewest(const SlidingWindow& window) { return seenIn(window.lines, window.frames.back().id); }

}  // namespace lintel
