// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/pages/RunSeries.h"
#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// Problems and near-problems of a run with their remedies, the most severe first; empty if there are none.
/// `calibration` is what the recording came with; `recording_warnings` is what reading it found.
std::vector<std::string> adviceFor(const OdometryResult& result, const Rig& calibration, const RunSeries& series,
                                   const std::vector<std::string>& recording_warnings);

}  // namespace lintel
