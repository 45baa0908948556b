// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/pipeline/Odometry.h"
#include "lintel/pipeline/RunCosts.h"

namespace lintel {

/// The figures of a run as JSON (stats.json of lintel-vio). `given`: the calibration that the recording came with;
/// `command`: the arguments that decided what was computed.
std::string statisticsJson(const OdometryResult& result, const Rig& given, const RunCosts& costs,
                           const std::vector<std::string>& warnings, const std::vector<std::string>& command = {});

/// Peak resident memory of this process [MB].
double peakMemoryMb();

}  // namespace lintel
