// SPDX-License-Identifier: BSD-3-Clause
#include "window/LastingPoints.h"

#include <algorithm>
#include <map>

namespace lintel {

namespace {

double squaredResidual(SlidingWindow& window, const Factor& factor) {
  std::vector<const double*> blocks;
  for (const BlockKey& key : factor.blocks) blocks.push_back(window.block(key));
  Eigen::Vector2d r;
  factor.cost->Evaluate(blocks.data(), r.data(), nullptr);
  return r.squaredNorm();
}

/// A prior is linear: in a point whose depth is known to a few per cent it stays true while the depth improves.
bool isPlaced(const PointTrack& track) {
  constexpr double kMostRelativeSigma = 0.05;
  return track.sigma_inverse_depth * track.point.head<3>().norm() < kMostRelativeSigma * track.point[3];
}

/// Whether a track reaches from the oldest frame to the newest, with gaps at most for a quarter of the window.
bool spansWindow(const SlidingWindow& window, const PointTrack& track) {
  return track.sightings.front().frame == window.frames.front().id &&
         track.sightings.back().frame == window.frames.back().id &&
         4 * track.sightings.size() >= 3 * (window.frames.size() - 1);
}

/// Whether the prior may take a point in: one that it knows already if the newest frame sees it.
bool mayLast(const SlidingWindow& window, const PointTrack& track, bool known) {
  return known ? track.sightings.back().frame == window.frames.back().id
               : isPlaced(track) && spansWindow(window, track);
}

/// Chi-square per degree of freedom of the points that may last: two numbers a sighting, three for the point's place
/// unless a prior knows it.
std::map<BlockKey, double> chiSquares(SlidingWindow& window, const std::vector<Factor>& measurements,
                                      const std::set<BlockKey>& known) {
  std::map<BlockKey, double> result;
  for (const Factor& factor : measurements) {
    const BlockKey& key = factor.blocks.back();
    if (key.kind != BlockKey::kPoint || !isImageFactor(factor)) continue;
    const PointTrack& track = window.points.at(key.id);
    const bool in_prior = known.count(key) > 0;
    if (!mayLast(window, track, in_prior)) continue;
    const double freedom = 2.0 * static_cast<double>(track.sightings.size()) - (in_prior ? 0 : 3);
    result[key] += squaredResidual(window, factor) / freedom;
  }
  return result;
}

}  // namespace

std::set<BlockKey> pointsInPriors(const SlidingWindow& window) {
  std::set<BlockKey> result;
  for (const WindowPrior& prior : window.priors)
    for (const BlockKey& key : prior.blocks)
      if (key.kind == BlockKey::kPoint) result.insert(key);
  return result;
}

std::set<BlockKey> lastingPoints(SlidingWindow& window, const std::vector<Factor>& measurements,
                                 const LandmarkParams& params) {
  const std::set<BlockKey> known = pointsInPriors(window);
  std::set<BlockKey> lasting;
  std::vector<std::pair<double, BlockKey>> ranked;
  for (const auto& [key, chi_square] : chiSquares(window, measurements, known)) {
    if (chi_square >= 1) continue;
    if (known.count(key) > 0)
      lasting.insert(key);
    else
      ranked.emplace_back(chi_square, key);
  }
  std::sort(ranked.begin(), ranked.end());
  for (const auto& [chi_square, key] : ranked)
    if (static_cast<int>(lasting.size()) < params.lasting_points) lasting.insert(key);
  return lasting;
}

}  // namespace lintel
