// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/evaluation/Consistency.h"
#include "lintel/evaluation/TrajectoryErrors.h"
#include "lintel/evaluation/TrueLines.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/reporting/Figure.h"

namespace lintel {

/// A trajectory as it is drawn; without a colour it gets one by its place.
struct NamedTrajectory {
  std::string name;
  StampedPoses poses;
  std::string colour;
};

/// The poses moved by an alignment.
StampedPoses moved(const StampedPoses& poses, const Similarity& S_a_b);

/// Trajectories from above. One named "truth" is grey and below the others.
Figure topView(const std::vector<NamedTrajectory>& trajectories);

/// Height over time after `t0_ns`.
Figure heightOverTime(const std::vector<NamedTrajectory>& trajectories, std::int64_t t0_ns);

/// (name, errors over time)
using NamedErrors = std::vector<std::pair<std::string, TrajectoryErrors>>;
Figure errorOverTime(const NamedErrors& errors);

/// Position error along an axis of the estimate's world over time, with a band of three standard deviations.
Figure errorWithSigma(const Consistency& consistency, int axis);

/// Box plots over the length of the stretches: translation error in percent of it.
Figure relativeErrorBoxes(const NamedErrors& errors);

/// A map from above, moved by `S_a_map`: well determined, degenerate and constrained lines differ. `truth` in grey
/// below it, `trajectory` above; both may be empty.
Figure mapFromAbove(const LineMap& map, const Similarity& S_a_map, const std::vector<TrueLine>& truth,
                    const StampedPoses& trajectory);

}  // namespace lintel
