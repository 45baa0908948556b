// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/mapping/MapPieces.h"
#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// How far the causal trajectory is from the refined one, at the times that both have. Place and yaw of each piece are
/// not observable: what its poses have in common of these is no difference.
struct RefinedComparison {
  double rms_m = 0;   ///< of the positions
  double path_m = 0;  ///< along the refined one, at these times
};

/// `pieces`: between interruptions of the estimate, empty: one piece. Trajectories in the order of time.
RefinedComparison compareWithRefined(const std::vector<OdometryPose>& causal, const std::vector<OdometryPose>& refined,
                                     const std::vector<MapPiece>& pieces);

/// Why the causal trajectory is not to be trusted beside the refined one; empty: they agree, or there is none.
std::string contradictionOf(const OdometryResult& result);

}  // namespace lintel
