// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace lintel {

/// 256 comparisons of grey levels around a feature (ORB).
using PlaceDescriptor = std::array<std::uint64_t, 4>;

/// What an image looks like at one place.
struct PlaceFeature {
  static constexpr std::int64_t kNoTrack = -1;

  Eigen::Vector2f px = Eigen::Vector2f::Zero();  ///< raw (distorted) pixels
  std::int64_t track = kNoTrack;                 ///< of the point that is tracked here
  std::uint8_t level = 0;                        ///< size, of a tracked point: 0 1 2 from small to large
  PlaceDescriptor descriptor{};
};

/// What a keyframe looks like. A tracked point has several features, one for each size at which it is described.
struct PlaceView {
  std::int64_t t_ns = 0;
  std::vector<PlaceFeature> features;
};

}  // namespace lintel
