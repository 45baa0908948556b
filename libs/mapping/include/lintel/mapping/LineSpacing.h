// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Removes lines beside better observed ones: of parallel lines closer than `params.spacing` only the one with the
/// larger product of views and length stays; one whose product is three times as large removes others within twice the
/// width. Merging has already joined estimates of the same edge; these are separate lines such as joints of planks,
/// folds and prints beside an edge. Groups are found anew. Returns the number of removed lines.
int spaceLines(const MapParams& params, LineMap& map);

}  // namespace lintel
