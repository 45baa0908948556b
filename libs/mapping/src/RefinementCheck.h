// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/mapping/BatchRefinement.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// Takes out of the points those that are left out of an adjustment to judge it: this share of the tracks.
std::vector<PointRecord> takeHeldOut(double share, std::vector<PointRecord>& points);

/// A material without landmarks, which are most of it.
MapMaterial camerasOf(const MapMaterial& material);

/// Whether a refined material may be used: completes `report` by what changed since `before` (camerasOf() the material
/// then), by how the held-out points fit, and by the verdict.
void judgeRefinement(const MapMaterial& before, const std::vector<PointRecord>& held_out, const MapMaterial& after,
                     const EstimatorParams& estimator, const MapParams& map, const RefinementParams& params,
                     RefinementReport& report);

}  // namespace lintel
