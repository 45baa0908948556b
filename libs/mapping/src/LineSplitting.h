// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineFitting.h"

namespace lintel {

/// Undoes wrong merges: a track of a merged line most of whose views the line does not explain
/// becomes a line of its own again, not known yet, with an id beyond all others. Returns how many.
int splitLines(std::vector<LineRecord>& lines);

}  // namespace lintel
