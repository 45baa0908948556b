// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowMarginalization.h"

#include <algorithm>

#include "solver/Marginalizer.h"
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
                     const std::set<BlockKey>& dropped) {
  for (const WindowPrior& prior : priors) factors.push_back({prior.factor.get(), nullptr, prior.blocks});
  if (auto prior = marginalise(window, factors, dropped)) window.priors.push_back(std::move(*prior));
}

/// The blocks that leave with a frame: its states, and the points and lines that its image sees.
std::set<BlockKey> leavingWith(const WindowFrame& frame, const std::vector<Factor>& factors) {
  const BlockKey pose{BlockKey::kPose, frame.id};
  std::set<BlockKey> leaving{pose, {BlockKey::kMotion, frame.id}};
  for (const Factor& factor : factors)
    if (factor.blocks.front() == pose && isLandmark(factor.blocks.back()) && isImageFactor(factor))
      leaving.insert(factor.blocks.back());
  return leaving;
}

/// Whether a prior may hold a block for as long as the window lasts. Points and lines leave with their tracks, and
/// shared directions stay out of priors: which lines share one is decided anew with every frame.
bool outlastsTracks(const BlockKey& key) { return !isLandmark(key) && key.kind != BlockKey::kDirection; }

/// The factors that become part of the prior: those that touch a block that leaves, if a prior may hold all others. Not
/// the sightings by the newest frame: a track that goes on starts anew with its newest sighting.
std::vector<Factor> goingWith(const std::set<BlockKey>& leaving, FrameId newest, const std::vector<Factor>& factors) {
  std::vector<Factor> result;
  const auto leaves = [&](const BlockKey& key) { return leaving.count(key) > 0; };
  for (const Factor& factor : factors)
    if (!(isImageFactor(factor) && factor.blocks.front().id == newest) &&
        std::any_of(factor.blocks.begin(), factor.blocks.end(), leaves) &&
        std::all_of(factor.blocks.begin(), factor.blocks.end(),
                    [&](const BlockKey& key) { return outlastsTracks(key) || leaves(key); }))
      result.push_back(factor);
  return result;
}

/// Sightings that have been used: a track that goes on keeps only the newest. (The oldest goes with its frame.)
template <class Tracks>
void consumeSightings(Tracks& tracks, BlockKey::Kind kind, const std::set<BlockKey>& dropped, FrameId newest) {
  for (auto& [id, track] : tracks)
    if (dropped.count({kind, id}) && track.sightings.back().frame == newest && track.sightings.size() > 2) {
      track.former.insert(track.former.end(), track.sightings.begin() + 1, track.sightings.end() - 1);
      track.sightings.erase(track.sightings.begin() + 1, track.sightings.end() - 1);
    }
}

}  // namespace

void marginaliseOldest(SlidingWindow& window, const std::vector<Factor>& measurements) {
  const std::set<BlockKey> leaving = leavingWith(window.frames.front(), measurements);
  const FrameId newest = window.frames.back().id;
  marginaliseWith(window, goingWith(leaving, newest, measurements), takePriors(window, leaving), leaving);
  for (auto& [id, track] : window.lines)
    if (leaving.count({BlockKey::kLine, id}) && track.verdict == LineVerdict::kGood &&
        (!track.best || track.sigma_direction_rad < track.best->sigma_direction_rad))
      track.best = KnownLine{track.line, track.origin_w, track.sigma_direction_rad, track.sigma_distance_m};
  consumeSightings(window.points, BlockKey::kPoint, leaving, newest);
  consumeSightings(window.lines, BlockKey::kLine, leaving, newest);
}

void marginaliseOldest(SlidingWindow& window, const EstimatorParams& params) {
  WindowFactors factors(window, params.factors);
  factors.addMeasurements(params);
  marginaliseOldest(window, factors.factors());
}

void marginaliseSecondNewest(SlidingWindow& window) {
  const std::size_t n = window.frames.size();
  const WindowFrame& leaving = window.frames[n - 2];
  WindowFrame& newest = window.frames[n - 1];
  const std::set<BlockKey> dropped{{BlockKey::kPose, leaving.id}, {BlockKey::kMotion, leaving.id}};
  if (const std::vector<WindowPrior> priors = takePriors(window, dropped); !priors.empty())
    marginaliseWith(window, {}, priors, dropped);
  auto joined = std::make_shared<Preintegration>(*leaving.imu);
  joined->append(*newest.imu);
  newest.imu = std::move(joined);
}

}  // namespace lintel
