// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lintel {

// Densities of what is not known about a motion that an IMU did not measure: over half a second, the longest time that
// is bridged, 0.1 rad and 0.4 m/s remain open when rates change by 0.5 rad/s and 2 m/s^2 within a quarter of a second.
inline constexpr double kUnmeasuredGyro = 0.15;  ///< [rad/s/sqrt(Hz)]
inline constexpr double kUnmeasuredAccel = 0.6;  ///< [m/s^2/sqrt(Hz)]

}  // namespace lintel
