// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <boost/container/small_vector.hpp>
#include <memory>
#include <type_traits>

#include "lintel/estimator/SlidingWindow.h"
#include "lintel/factors/ImageFactor.h"
#include "lintel/factors/Manifolds.h"
#include "lintel/factors/TrackNoise.h"

namespace lintel {

/// The blocks that a residual depends on; the four of a sighting lie in the factor itself.
using FactorBlocks = boost::container::small_vector<BlockKey, 4>;

/// A residual of the window: its cost, its loss (null: none) and the blocks it depends on.
struct Factor {
  const ceres::CostFunction* cost = nullptr;
  const ceres::LossFunction* loss = nullptr;
  FactorBlocks blocks;
  /// Of an image's residuals with a point or a line; the same in all of a track.
  const TrackNoise* noise = &kWhiteNoise;
};

/// A prior as a residual; it must outlive the factor.
inline Factor factorOf(const WindowPrior& prior) {
  return {prior.factor.get(), nullptr, {prior.blocks.begin(), prior.blocks.end()}};
}

/// The manifold of a kind of block; shared, stateless.
const std::shared_ptr<const StateManifold>& manifoldOf(BlockKey::Kind kind);

inline bool isLandmark(const BlockKey& key) { return key.kind == BlockKey::kPoint || key.kind == BlockKey::kLine; }

/// The kind of block that an image's target is.
template <class Target>
constexpr BlockKey::Kind kKindOf = std::is_same_v<Target, PointTarget>  ? BlockKey::kPoint
                                   : std::is_same_v<Target, LineTarget> ? BlockKey::kLine
                                                                        : BlockKey::kDirection;

/// The factor as a residual of an image that sees such a target; null when it is none.
template <class Target>
const ImageFactor<Target>* imageFactorOf(const Factor& factor) {
  if (factor.blocks.size() != 4 || factor.blocks.back().kind != kKindOf<Target>) return nullptr;
  return dynamic_cast<const ImageFactor<Target>*>(factor.cost);
}

/// Whether the factor is a residual of an image.
inline bool isImageFactor(const Factor& factor) {
  return imageFactorOf<PointTarget>(factor) || imageFactorOf<LineTarget>(factor) ||
         imageFactorOf<DirectionTarget>(factor);
}

}  // namespace lintel
