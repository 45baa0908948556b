// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/geometry/Segment.h"
#include "lintel/mapping/KeyframeCameras.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// What a line's views say of it.
struct LineEvidence {
  bool known = false;       ///< enough for the map
  bool degenerate = false;  ///< they do not determine its direction or position
  Segment3 segment_w;  ///< from where to where it was seen; start and end correspond to those of the first inlier view
  double sigma_direction_rad = 0, sigma_distance_m = 0;  ///< the latter at the worse end
};

LineEvidence evidenceOf(const MapParams& params, const KeyframeCameras& cameras, const LineRecord& line);

}  // namespace lintel
