// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/evaluation/TrueLines.h"
#include "lintel/geometry/Alignment.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

struct ConsistencyParams {
  double max_angle_rad = 0.26179938779914943654;  ///< between a line and its edge: 15 degrees
  double near_m = 0.10;                           ///< an end is near an edge that is not farther
  double reach_m = 0.30;           ///< edges farther from a line's middle are not looked at in the images
  double max_offset_px = 1.5;      ///< of an observed end from the projected edge,
  double least_share = 0.9;        ///< in this share of the observations
  double max_difference_s = 0.01;  ///< between a keyframe and its true pose
};

/// How often ends of lines are as near to their true edge's (infinite) line as their sigma_distance_m says: 0.95 within
/// two of them where the error lies in one direction across the line, as the depth does, 0.86 where it is the same all
/// around. NaN where there are no ends.
struct SigmaShares {
  std::size_t ends = 0;
  double within_1 = std::numeric_limits<double>::quiet_NaN(), within_2 = within_1;
};

/// For tracked lines, for those found in images afterwards, and for those whose direction others hold.
struct ConsistencyBySource {
  SigmaShares tracked, mapped, constrained;
};

struct LineConsistency {
  ConsistencyBySource near;  ///< ends near any edge of the line's direction, be it the line's or one beside it
  /// Lines whose observations show an edge: projected with the true poses, it is where they are. Empty without such.
  ConsistencyBySource seen;
};

/// `S_truth_map` lays the map onto the truth; `groundtruth`: true poses of the body, may be empty.
LineConsistency evaluateConsistency(const LineMap& map, const Similarity& S_truth_map,
                                    const std::vector<TrueLine>& truth, const StampedPoses& groundtruth,
                                    const ConsistencyParams& params = {});

}  // namespace lintel
