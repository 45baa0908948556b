// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/KeyframeCameras.h"
#include "lintel/mapping/LineFitting.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// The structural constraint for the map: a line whose views do not determine its direction or position, and that the
/// window found parallel to others, is fitted again with the direction of a group of lines whose directions are known
/// and with the points that lie on it, and replaced by that fit if its views agree with it. Others stay as they are.
/// Returns how many were constrained.
int tieDegenerateLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MapParams& params,
                       const std::vector<MapGroup>& groups, MapMaterial& material);

/// Fits known lines again whose directions agree with a group's within their sigmas, with that direction as one more
/// measurement; replaced where the views agree. They do not count as tied. Returns how many.
int alignToGroups(const KeyframeCameras& cameras, const LineFitParams& fit, const MapParams& params,
                  const std::vector<MapGroup>& groups, MapMaterial& material);

}  // namespace lintel
