// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/pipeline/Odometry.h"
#include "lintel/pipeline/RunCosts.h"

namespace lintel {

/// The trajectory as TUM text: `t x y z qx qy qz qw`, seconds with 9 decimals.
std::string trajectoryText(const std::vector<OdometryPose>& trajectory);

/// Figures of a run as JSON (stats.json). `given`: the calibration that the recording came with.
std::string statisticsJson(const OdometryResult& result, const Rig& given, const RunCosts& costs,
                           const std::vector<std::string>& warnings);

/// Peak resident memory of this process [MB].
double peakMemoryMb();

}  // namespace lintel
