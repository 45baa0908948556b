// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowRetirement.h"

#include <cmath>
#include <optional>

#include "landmarks/LineTriangulation.h"
#include "window/WindowStamps.h"

namespace lintel {

namespace {

template <class Sighting>
std::vector<Sighting> allSightings(const std::vector<Sighting>& former, const std::vector<Sighting>& present) {
  std::vector<Sighting> all = former;
  all.insert(all.end(), present.begin(), present.end());
  return all;
}

/// What the window could not place may still become known from all keyframes together.
template <class Retired, class Track>
void retireUnplaced(const Track& track, std::vector<Retired>& retired) {
  Retired r;
  r.id = track.id;
  r.triangulated = false;
  r.sightings = allSightings(track.former, track.sightings);
  if (r.sightings.size() >= 2) retired.push_back(std::move(r));
}

void retirePoint(const SlidingWindow& window, const PointTrack& track, WindowUpdate& update) {
  if (!track.triangulated || track.sightings.empty() || track.point[3] <= 0)
    return retireUnplaced(track, update.points);
  const Eigen::Vector3d p_w = window.positionOf(track);
  const double distance = (p_w - window.T_w_c(window.frame(track.sightings.front().frame)).p).norm();
  update.points.push_back(
      {track.id, p_w, track.sigma_inverse_depth * distance * distance, allSightings(track.former, track.sightings)});
}

void retireLine(const LineTrack& track, WindowUpdate& update) {
  if (!track.triangulated && !track.best) return retireUnplaced(track, update.lines);
  if (track.best && (!track.triangulated || track.best->sigma_direction_rad <= track.sigma_direction_rad)) {
    LineTrack known = track;  // what it was when it was known best
    known.line = track.best->line;
    known.origin_w = track.best->origin_w;
    update.lines.push_back({track.id, lineInWorld(known), track.best->sigma_direction_rad, track.best->sigma_distance_m,
                            false, 0, allSightings(track.former, track.sightings)});
    return;
  }
  update.lines.push_back({track.id, lineInWorld(track), track.sigma_direction_rad, track.sigma_distance_m,
                          track.degenerate(), track.group, allSightings(track.former, track.sightings)});
}

/// Whether a track is of no more use without frame `leaving`.
template <class Track>
bool isSpent(const Track& track, FrameId leaving, FrameId newest) {
  if (track.sightings.empty()) return true;
  if (track.sightings.back().frame == newest) return false;
  std::size_t left = 0;
  for (const auto& s : track.sightings) left += s.frame != leaving;
  return left < 2;
}

/// Sightings of a frame that leaves without having been a keyframe are not handed over.
template <class Track>
void dropSighting(Track& track, FrameId frame) {
  for (std::size_t i = 1; i < track.sightings.size(); ++i)
    if (track.sightings[i].frame == frame) {
      track.sightings.erase(track.sightings.begin() + static_cast<std::ptrdiff_t>(i));
      return;
    }
}

}  // namespace

void retireTracks(SlidingWindow& window, FrameId leaving, bool keyframe, WindowUpdate& update) {
  const FrameId newest = window.frames.back().id;
  for (auto it = window.points.begin(); it != window.points.end();) {
    if (!isSpent(it->second, leaving, newest)) {
      ++it;
      continue;
    }
    if (!keyframe) dropSighting(it->second, leaving);
    retirePoint(window, it->second, update);
    it = window.points.erase(it);
  }
  for (auto it = window.lines.begin(); it != window.lines.end();) {
    if (!isSpent(it->second, leaving, newest)) {
      ++it;
      continue;
    }
    if (!keyframe) dropSighting(it->second, leaving);
    retireLine(it->second, update);
    it = window.lines.erase(it);
  }
}

void retireKeyframe(const SlidingWindow& window, std::size_t k, WindowUpdate& update) {
  const WindowFrame& frame = window.frames[k];
  std::optional<InertialState> next;
  if (k + 1 < window.frames.size()) next = stateOf(window.frames[k + 1]);
  update.keyframes.push_back({frame.id, frame.t_ns, frame.T_w_b(), velocityOf(frame.motion.data()),
                              biasOf(frame.motion.data()), frame.imu, frame.at_rest, frame.blind, window.imuAxes(),
                              next});
}

void retireAll(SlidingWindow& window, WindowUpdate& update) {
  for (const auto& [id, track] : window.points) retirePoint(window, track, update);
  for (const auto& [id, track] : window.lines) retireLine(track, update);
  for (std::size_t k = 0; k < window.frames.size(); ++k) retireKeyframe(window, k, update);
  window.points.clear();
  window.lines.clear();
  window.frames.clear();
  window.priors.clear();
}

}  // namespace lintel
