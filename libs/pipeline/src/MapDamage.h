// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// Whether a map holds poses, IMU samples or times that are out of range. Maps may come from anyone; an adjustment of
/// such numbers could only fail, and their times could not be counted with.
bool isDamaged(const LineMap& map);

}  // namespace lintel
