// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "PointFitting.h"
#include "lintel/mapping/PointJoin.h"

namespace lintel {

/// Joins points of two visits, for an adjustment: appends a record with the views of all tracks that `joins` says are
/// of one point, if one position explains nine tenths of the views up to `most_px`. The records of the visits stay
/// beside it. Its `extra_sigma_px` is what the visits still are apart, at least `sigma_px`: a join that is far off, or
/// wrong, holds hardly anything, and as `most_px` falls from round to round it is left out (graduated non-convexity,
/// [Yang2020]). Returns how many of the joins hold, those included whose tracks are one record already.
int joinPoints(const KeyframeCameras& cameras, const PointFitParams& fit, const std::vector<PointJoin>& joins,
               double most_px, double sigma_px, std::vector<PointRecord>& points);

}  // namespace lintel
