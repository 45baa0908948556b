// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/evaluation/TrajectoryErrors.h"

namespace lintel {

/// An estimated pose and its true partner. The estimate is in any frame, its scale that of the alignment.
struct PartneredPose {
  Pose T_e_b, T_w_b;
};

/// Relative errors for every distance of `params` and for the whole path. `poses` in order of time.
std::vector<RelativeErrors> relativeErrors(const std::vector<PartneredPose>& poses,
                                           const TrajectoryErrorParams& params);

}  // namespace lintel
