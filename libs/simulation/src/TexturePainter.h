// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/simulation/Scene.h"

namespace lintel {

/// Paints a material's tile: resolution_px squared values, 128 = the material's albedo, seamless at the borders (except
/// posters, which are shown once). Rich in corners, poor in long straight edges: those are geometry (SceneLine).
std::vector<std::uint8_t> paintTexture(const Material& material);

}  // namespace lintel
