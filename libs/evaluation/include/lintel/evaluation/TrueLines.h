// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/geometry/Segment.h"

namespace lintel {

/// A true edge of a simulated scene.
struct TrueLine {
  Segment3 segment_w;
  int frames_seen = 0;  ///< number of frames of the recording that show it
};

/// Reads true lines, a CSV as in `mav0/lines0/data.csv`. The first row (it may start with #) names the columns, a unit
/// in brackets may follow a name: x0 y0 z0 x1 y1 z1 [m] are needed; without a column frames_seen every line counts as
/// always seen. Rows without length are left out.
/// Throws EvaluationError (TrajectoryFile.h) on an unreadable file, a missing column or a malformed row.
std::vector<TrueLine> readTrueLines(const std::string& path);

}  // namespace lintel
