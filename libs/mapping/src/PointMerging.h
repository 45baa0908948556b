// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointFitting.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Makes one point of those that are the same corner, lost and found again under another identity: never in one image
/// together, close to each other, and one position explains the views of both. Returns the number of points that went.
int mergePoints(const KeyframeCameras& cameras, const PointFitParams& fit, const MergeParams& params,
                std::vector<PointRecord>& points);

}  // namespace lintel
