// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/estimator/WindowUpdate.h"
#include "lintel/inertial/ImuAxes.h"

namespace lintel {

/// Mean of what the accelerometer measured between all keyframes [m/s^2]; zero without an IMU.
Eigen::Vector3d meanSpecificForce(const std::vector<RetiredKeyframe>& keyframes);

/// The keyframes' samples become those of right axes, and the axes right ones.
void correctSamples(ImuAxes& axes, std::vector<RetiredKeyframe>& keyframes);

}  // namespace lintel
