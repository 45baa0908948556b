// SPDX-License-Identifier: BSD-3-Clause
#include "WindowMarginalization.h"

#include <algorithm>

#include "Marginalizer.h"

namespace lintel {

namespace {

/// Takes the priors that touch one of `blocks` out of the window.
std::vector<WindowPrior> takePriors(SlidingWindow& window, const std::set<BlockKey>& blocks) {
  const auto touches = [&](const WindowPrior& prior) {
    return std::any_of(prior.blocks.begin(), prior.blocks.end(), [&](const BlockKey& k) { return blocks.count(k) > 0; });
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
  for (const auto& [id, track] : window.points)
    if (track.triangulated && track.sightings.size() > 1 && track.sightings.front().frame == oldest.id) {
      factors.addPoint(track);
      dropped.insert({BlockKey::kDepth, id});
    }
  for (const auto& [id, track] : window.lines)
    if (track.triangulated && !track.degenerate && track.sightings.size() > 1 &&
        track.sightings.front().frame == oldest.id) {
      factors.addLine(track);
      dropped.insert({BlockKey::kLine, id});
    }
  marginaliseWith(window, factors.factors(), takePriors(window, dropped), dropped);
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
