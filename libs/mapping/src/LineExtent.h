// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "lintel/geometry/Segment.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

/// The stretch of a line that enough of its observations saw. `intervals`: (from, to) along the line [m], one per
/// observation; `share`: of the observations, at least two of them. From the first to the last well-covered place, so
/// that one observation that ran past the end does not lengthen the line. Empty when no place is covered well.
std::optional<std::pair<double, double>> coveredStretch(const std::vector<std::pair<double, double>>& intervals,
                                                        double share);

/// From where to where a line was seen, metres from its middle along its direction, from < to. Each track of a merged
/// line gives its coveredStretch(): a piece that was seen less often than another still counts, a single view that ran
/// past the end does not.
std::optional<std::pair<double, double>> seenStretch(const KeyframeCameras& cameras, const LineRecord& line,
                                                     double share);

/// The drawn segment; start and end correspond to those of the first inlier view.
Segment3 segmentOf(const KeyframeCameras& cameras, const LineRecord& line, const std::pair<double, double>& stretch);

}  // namespace lintel
