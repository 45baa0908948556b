// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// The states of a material are those at the frames' stamps; the images were taken later by the offset between the
/// clocks that has been estimated (time_offset_s + offset_change_s). The poses T_w_b at which the images were taken, by
/// the motion that the neighbours in the trajectory show.
std::vector<std::pair<std::int64_t, Pose>> posesOfImages(const MapMaterial& material);

/// The reverse, to the second order in the offset: the states of frames whose images were taken at the poses `images`,
/// a trajectory of the material's pieces.
std::vector<std::pair<std::int64_t, Pose>> posesOfStates(const MapMaterial& material,
                                                         const std::vector<std::pair<std::int64_t, Pose>>& images);

}  // namespace lintel
