// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/estimator/WindowUpdate.h"
#include "lintel/geometry/Pose.h"

namespace lintel {

/// The poses T_w_b that the IMU gives at `times_ns`, ascending, between two keyframes (`to.imu` leads from the one to
/// the other); what is missing at the end is spread over the interval, so that both keyframes' states are met.
std::vector<Pose> posesBetween(const RetiredKeyframe& from, const RetiredKeyframe& to,
                               const std::vector<std::int64_t>& times_ns);

}  // namespace lintel
