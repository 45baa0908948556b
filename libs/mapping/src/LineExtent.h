// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "KeyframeCameras.h"
#include "lintel/geometry/Segment.h"

namespace lintel {

/// From where to where a line was seen, metres from its middle along its direction, from < to. Each track of a merged
/// line gives the stretch that enough of its own views saw (`share`, SegmentEnds.h): a piece that was seen less often
/// than another still counts, a single view that ran past the end does not.
std::optional<std::pair<double, double>> seenStretch(const KeyframeCameras& cameras, const LineRecord& line,
                                                     double share);

/// The drawn segment; start and end correspond to those of the first inlier view.
Segment3 segmentOf(const KeyframeCameras& cameras, const LineRecord& line, const std::pair<double, double>& stretch);

/// Views that agree with the estimate.
int inliersOf(const LineRecord& line);

/// Different keyframes among the inliers.
int keyframesOf(const LineRecord& line);

}  // namespace lintel
