// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "lintel/core/CameraTurn.h"
#include "lintel/core/Frame.h"

namespace lintel {

/// Whether the images were turned so that they do not shake, as telephones do with films: over seconds they turn as the
/// gyroscope does, within tenths of a second less. In words; empty when not, where clocks that differ by up to 0.1 s
/// explain the turns as well, and where the gyroscope's noise would make it seem so. Samples ascend in time.
std::string stabilisationFault(const ImuBatch& imu, const Eigen::Quaterniond& R_b_c,
                               const std::vector<CameraTurn>& turns);

}  // namespace lintel
