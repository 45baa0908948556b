// SPDX-License-Identifier: BSD-3-Clause
#include "solver/Factor.h"

#include <array>

namespace lintel {

const std::shared_ptr<const StateManifold>& manifoldOf(BlockKey::Kind kind) {
  using Manifold = std::shared_ptr<const StateManifold>;
  static const Manifold pose = std::make_shared<PoseManifold>();
  static const std::array<Manifold, 9> manifolds{pose,  // in the order of BlockKey::Kind
                                                 std::make_shared<VectorManifold>(kMotionSize),
                                                 pose,
                                                 std::make_shared<VectorManifold>(kCorrectionSize),
                                                 std::make_shared<VectorManifold>(kMeanBiasSize),
                                                 std::make_shared<VectorManifold>(kAxesSize),
                                                 std::make_shared<DirectionManifold>(),
                                                 std::make_shared<PointManifold>(),
                                                 std::make_shared<LineManifold>()};
  return manifolds[static_cast<std::size_t>(kind)];
}

}  // namespace lintel
