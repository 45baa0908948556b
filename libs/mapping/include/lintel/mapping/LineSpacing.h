// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Leaves out of the map what crowds it: of parallel lines closer than `params.spacing` says only the better seen stays
/// (views times length). One that is seen three times as well clears twice the width. Merging has made one of those
/// that are the same; here are joints of planks, folds and prints beside an edge, lines of their own that only blur its
/// picture. Groups are found anew. Returns how many lines went.
int spaceLines(const MapParams& params, LineMap& map);

}  // namespace lintel
