// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointFitting.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Joins points that are estimates of the same corner, tracked with different identities: never in one image together,
/// close to each other, and one position explains the views of both. Returns the number of points that were joined to
/// others.
int mergePoints(const KeyframeCameras& cameras, const PointFitParams& fit, const MergeParams& params,
                std::vector<PointRecord>& points);

}  // namespace lintel
