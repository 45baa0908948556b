// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/simulation/SceneLibrary.h"

namespace lintel {

Scene buildRoom(const SceneRequest& request);
Scene buildHall(const SceneRequest& request);
Scene buildCorridor(const SceneRequest& request);
Scene buildBraces(const SceneRequest& request);

}  // namespace lintel
