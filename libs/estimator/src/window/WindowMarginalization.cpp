// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowMarginalization.h"

#include <algorithm>

#include "landmarks/LineDegeneracy.h"
#include "solver/Marginalizer.h"

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

}  // namespace

void marginaliseOldest(SlidingWindow& window, const EstimatorParams& params) {
  const WindowFrame& oldest = window.frames.front();
  std::set<BlockKey> dropped{{BlockKey::kPose, oldest.id}, {BlockKey::kMotion, oldest.id}};
  WindowFactors factors(window, params.factors);
  factors.addImuAfter(oldest.id);
  factors.addRestOf(oldest, params.rest_velocity_sigma);
  const FrameId newest = window.frames.back().id;
  for (const auto& [id, track] : window.points)
    if (track.triangulated && track.sightings.size() > 1 && track.sightings.front().frame == oldest.id) {
      factors.addPoint(track);
      dropped.insert({BlockKey::kPoint, id});
    }
  for (const auto& [id, track] : window.lines)
    if (entersProblem(track, params.degeneracy) && !track.sightings.empty() &&
        track.sightings.front().frame == oldest.id) {
      if (!track.placed || track.sightings.size() < 2) continue;  // shared directions stay out of the prior
      factors.addSightings(track);
      dropped.insert({BlockKey::kLine, id});
    }
  marginaliseWith(window, factors.factors(), takePriors(window, dropped), dropped);
  // Their sightings have been used: a track that goes on keeps only the newest, so that nothing counts twice.
  // (The oldest goes with its frame.)
  const auto consume = [&](auto& tracks, BlockKey::Kind kind) {
    for (auto& [id, track] : tracks)
      if (dropped.count({kind, id}) && track.sightings.back().frame == newest && track.sightings.size() > 2) {
        track.former.insert(track.former.end(), track.sightings.begin() + 1, track.sightings.end() - 1);
        track.sightings.erase(track.sightings.begin() + 1, track.sightings.end() - 1);
      }
  };
  for (auto& [id, track] : window.lines)
    if (dropped.count({BlockKey::kLine, id}) && track.verdict == LineVerdict::kGood &&
        (!track.best || track.sigma_direction_rad < track.best->sigma_direction_rad))
      track.best = KnownLine{track.line, track.origin_w, track.sigma_direction_rad, track.sigma_distance_m};
  consume(window.points, BlockKey::kPoint);
  consume(window.lines, BlockKey::kLine);
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
