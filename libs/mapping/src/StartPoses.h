// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// A start is made of seconds of frames, and the first pose is that of the last one. Adds poses of the frames before it
/// to `material.trajectory`: of those among `frames_ns`, ascending, that have none and lie between two keyframes which
/// the IMU connects.
void addPosesOfStarts(const std::vector<std::int64_t>& frames_ns, MapMaterial& material);

}  // namespace lintel
