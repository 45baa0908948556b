// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>

#include "lintel/mapping/LineEvidence.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// How well a line is known.
enum class LineState {
  kNoEvidence,  ///< too few views that agree
  kDegenerate,  ///< its views do not determine direction or position
  kKnown,
};

struct LineJudgement {
  LineState state = LineState::kNoEvidence;
  std::optional<std::pair<double, double>> stretch;      ///< from where to where it was seen (LineExtent.h)
  double sigma_direction_rad = 0, sigma_distance_m = 0;  ///< the latter at the worse end of the stretch
};

LineJudgement judgeMapLine(const MapParams& params, const KeyframeCameras& cameras, const LineRecord& line);

}  // namespace lintel
