// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/MapMaterial.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// For lines that a map has already: a tenth may be too uncertain, as maps do not keep the sigmas of views.
constexpr double kShareOfOwnLines = 0.9;

/// Where everything is far for the way that the camera goes, hardly a line is known to `max_sigma_m`. Gives limits with
/// which drawMap() draws at least `share` of the length that is known to `max_relative_sigma` of its distance:
/// `max_far_sigma` is raised where it has to be.
MapParams withFarLines(const MapParams& params, const MapMaterial& material, double share);

}  // namespace lintel
