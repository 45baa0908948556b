// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "lintel/simulation/SceneLibrary.h"
#include "lintel/simulation/Simulation.h"
#include "lintel/simulation/Trajectory.h"

namespace lintel {

/// The motion that `params` ask for in a scene of this kind. Throws std::invalid_argument or EvaluationError.
std::shared_ptr<const Trajectory> buildMotion(const MotionParams& params, const SceneKind& kind, const Rig& rig);

/// What the scene is built around: the scene's usual hull for a figure, one that fits round a given trajectory.
SceneRequest requestFor(const SceneKind& kind, const MotionParams& params, const Trajectory& trajectory,
                        double duration_s, std::uint64_t seed);

}  // namespace lintel
