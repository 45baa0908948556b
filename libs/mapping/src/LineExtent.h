// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "lintel/geometry/Segment.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

/// What an observation saw of a line, from < to along it [m]. An end at the border of the image is open: the line may
/// go on where the camera does not see it.
struct SeenPiece {
  double from = 0, to = 0;
  bool from_open = false, to_open = false;
  double from_m_per_px = 0, to_m_per_px = 0;  ///< how far a pixel moves the end along the line
};

/// The stretch of a line that at least two observations saw, and `share` of those that would have seen it: the ones
/// that end before a place without being cut off by the image's border speak against it. From the first to the last
/// well-covered place, so that one observation that ran past the end does not lengthen the line. Empty when no place is
/// covered well.
std::optional<std::pair<double, double>> coveredStretch(const std::vector<SeenPiece>& pieces, double share);

/// From where to where a line was seen, metres from its middle along its direction, from < to. Each track of a merged
/// line gives its coveredStretch(): a piece that was seen less often than another still counts, a single view that ran
/// past the end does not. It ends where the views of all tracks agree that it does (AgreedEnds.h).
std::optional<std::pair<double, double>> seenStretch(const KeyframeCameras& cameras, const LineRecord& line,
                                                     double share);

/// The drawn segment; start and end correspond to those of the first inlier view.
Segment3 segmentOf(const KeyframeCameras& cameras, const LineRecord& line, const std::pair<double, double>& stretch);

}  // namespace lintel
