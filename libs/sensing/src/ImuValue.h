// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/Frame.h"

namespace lintel {

/// One of the six values of a sample: 0 to 2 are the gyroscope's [rad/s], 3 to 5 the accelerometer's [m/s^2].
inline double& imuValue(ImuSample& sample, int axis) { return axis < 3 ? sample.gyro[axis] : sample.accel[axis - 3]; }
inline double imuValue(const ImuSample& sample, int axis) {
  return axis < 3 ? sample.gyro[axis] : sample.accel[axis - 3];
}

}  // namespace lintel
