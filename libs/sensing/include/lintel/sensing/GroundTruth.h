// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "lintel/geometry/Pose.h"

namespace lintel {

/// The true poses (time [ns], T_w_b) that a recording carries, times ascending: of an EuRoC folder
/// `state_groundtruth_estimate0/data.csv`, of a rawlog its robot poses labelled "groundtruth". Empty when there are
/// none. A rawlog is read to its end, or to where it is damaged. Throws RecordingError when it cannot be opened.
std::vector<std::pair<std::int64_t, Pose>> readGroundTruth(const std::string& recording);

}  // namespace lintel
