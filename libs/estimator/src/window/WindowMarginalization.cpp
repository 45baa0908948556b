// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowMarginalization.h"

#include <algorithm>
#include <cmath>

#include "solver/Marginalizer.h"
#include "window/LastingPoints.h"
#include "window/WindowFactors.h"

namespace lintel {

namespace {

/// Takes the priors that touch one of `blocks` out of the window.
std::vector<WindowPrior> takePriors(SlidingWindow& window, const std::set<BlockKey>& blocks) {
  const auto touches = [&](const WindowPrior& prior) {
    return std::any_of(prior.blocks.begin(), prior.blocks.end(),
                       [&](const BlockKey& k) { return blocks.count(k) > 0; });
  };
  std::vector<WindowPrior> taken, kept;
  for (WindowPrior& prior : window.priors) (touches(prior) ? taken : kept).push_back(std::move(prior));
  window.priors = std::move(kept);
  return taken;
}

void marginaliseWith(SlidingWindow& window, std::vector<Factor> factors, const std::vector<WindowPrior>& priors,
                     const std::set<BlockKey>& dropped, const Staying& staying) {
  for (const WindowPrior& prior : priors) factors.push_back(factorOf(prior));
  if (auto prior = marginalise(window, factors, dropped, staying)) window.priors.push_back(std::move(*prior));
}

/// The blocks that leave with a frame: its states, the points and lines that its image sees, and points in priors; but
/// for those that stay.
std::set<BlockKey> leavingWith(const SlidingWindow& window, const WindowFrame& frame,
                               const std::vector<Factor>& factors, const std::set<BlockKey>& staying) {
  const BlockKey pose{BlockKey::kPose, frame.id};
  std::set<BlockKey> leaving{pose, {BlockKey::kMotion, frame.id}};
  for (const BlockKey& key : pointsInPriors(window))
    if (staying.count(key) == 0) leaving.insert(key);
  for (const Factor& factor : factors)
    if (factor.blocks.front() == pose && isLandmark(factor.blocks.back()) && isImageFactor(factor) &&
        staying.count(factor.blocks.back()) == 0)
      leaving.insert(factor.blocks.back());
  return leaving;
}

/// Whether a prior may hold any such block. Points and lines leave with their tracks, but for lasting points, and
/// shared directions stay out of priors: which lines share one is decided anew with every frame.
bool outlastsTracks(const BlockKey& key) { return !isLandmark(key) && key.kind != BlockKey::kDirection; }

/// The tracks whose sightings may become part of the prior when the oldest frame leaves: those that it sees, and points
/// that priors know.
TrackChoice mayGoWithOldest(const SlidingWindow& window) {
  const auto sees = [oldest = window.frames.front().id](const auto& track) {
    return !track.sightings.empty() && track.sightings.front().frame == oldest;
  };
  return {[sees, known = pointsInPriors(window)](const PointTrack& track) {
            return sees(track) || known.count({BlockKey::kPoint, track.id}) > 0;
          },
          sees};
}

/// The factors that become part of the prior: those that touch a block that leaves, if a prior may hold all others. Not
/// the sightings by the newest frame: a track that goes on starts anew with its newest sighting.
std::vector<Factor> goingWith(const std::set<BlockKey>& leaving, const std::set<BlockKey>& staying, FrameId newest,
                              const std::vector<Factor>& factors) {
  std::vector<Factor> result;
  const auto leaves = [&](const BlockKey& key) { return leaving.count(key) > 0; };
  for (const Factor& factor : factors)
    if (!(isImageFactor(factor) && factor.blocks.front().id == newest) &&
        std::any_of(factor.blocks.begin(), factor.blocks.end(), leaves) &&
        std::all_of(factor.blocks.begin(), factor.blocks.end(),
                    [&](const BlockKey& key) { return outlastsTracks(key) || staying.count(key) > 0 || leaves(key); }))
      result.push_back(factor);
  return result;
}

/// Sightings that have been used: a track that goes on keeps only the newest, one that was lost none. (The oldest goes
/// with its frame.)
template <class Tracks>
void consumeSightings(Tracks& tracks, BlockKey::Kind kind, const std::set<BlockKey>& dropped, FrameId newest) {
  for (auto& [id, track] : tracks) {
    if (dropped.count({kind, id}) == 0) continue;
    const auto used = track.sightings.begin() + 1;
    const auto end = track.sightings.end() - (track.sightings.back().frame == newest ? 1 : 0);
    if (used >= end) continue;
    track.former.insert(track.former.end(), used, end);
    track.sightings.erase(used, end);
  }
}

/// Whether a track is still one without frame `leaving`, as WindowRetirement sees it.
bool outlives(const PointTrack& track, FrameId leaving, FrameId newest) {
  return track.sightings.back().frame == newest ||
         std::count_if(track.sightings.begin(), track.sightings.end(),
                       [leaving](const PointSighting& s) { return s.frame != leaving; }) >= 2;
}

}  // namespace

void marginaliseOldest(SlidingWindow& window, const std::vector<Factor>& measurements, const LandmarkParams& params,
                       double scale_walk) {
  Staying staying{lastingPoints(window, measurements, params)};
  const double step_s = 1e-9 * static_cast<double>(window.frames[1].t_ns - window.frames[0].t_ns);
  staying.walk_rad = params.lasting_walk_px * std::sqrt(step_s) / window.camera().meanFocal();
  staying.scale_walk = scale_walk;
  if (const auto& imu = window.frames[1].imu) staying.bias_walk = imu->noise().accel_walk * std::sqrt(step_s);
  const std::set<BlockKey> leaving = leavingWith(window, window.frames.front(), measurements, staying.points);
  const FrameId newest = window.frames.back().id;
  marginaliseWith(window, goingWith(leaving, staying.points, newest, measurements), takePriors(window, leaving),
                  leaving, staying);
  for (auto& [id, track] : window.lines)
    if (leaving.count({BlockKey::kLine, id}) && track.verdict == LineVerdict::kGood &&
        (!track.best || track.sigma_direction_rad < track.best->sigma_direction_rad))
      track.best = KnownLine{track.line, track.origin_w, track.sigma_direction_rad, track.sigma_distance_m};
  consumeSightings(window.points, BlockKey::kPoint, leaving, newest);
  consumeSightings(window.lines, BlockKey::kLine, leaving, newest);
}

void marginaliseOldest(SlidingWindow& window, const EstimatorParams& params, double scale_walk) {
  WindowFactors factors(window, params.factors);
  factors.addMeasurements(params, mayGoWithOldest(window));
  marginaliseOldest(window, factors.factors(), params.landmarks, scale_walk);
}

void marginaliseSecondNewest(SlidingWindow& window) {
  const std::size_t n = window.frames.size();
  const WindowFrame& leaving = window.frames[n - 2];
  WindowFrame& newest = window.frames[n - 1];
  std::set<BlockKey> dropped{{BlockKey::kPose, leaving.id}, {BlockKey::kMotion, leaving.id}};
  Staying staying;
  for (const BlockKey& key : pointsInPriors(window))
    (outlives(window.points.at(key.id), leaving.id, newest.id) ? staying.points : dropped).insert(key);
  if (const std::vector<WindowPrior> priors = takePriors(window, dropped); !priors.empty())
    marginaliseWith(window, {}, priors, dropped, staying);
  newest.joinInterval(leaving);
}

}  // namespace lintel
