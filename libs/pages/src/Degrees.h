// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lintel {

inline constexpr double kDegrees = 180.0 / 3.14159265358979323846;  ///< in one radian

}  // namespace lintel
