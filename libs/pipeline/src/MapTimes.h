// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// By how much the times of each recording must move so that one recording lies behind the other, some time apart.
std::vector<std::int64_t> timesBehindOneAnother(const std::vector<MapPiece>& pieces);

/// Moves all times of each recording.
void moveTimes(const std::vector<std::int64_t>& by_ns, LineMap& map);

}  // namespace lintel
