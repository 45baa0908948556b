// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// Sets the map's corners and planes from its lines, with their covariances, and points (doc/method/structure.md).
/// Lines stay as they are.
void findStructure(LineMap& map);

}  // namespace lintel
