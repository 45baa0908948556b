// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LineFitting.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Makes one line of those that are the same: pieces of one edge, and what was lost and seen again under another
/// identity. Two lines are one when they are nearly parallel, close to each other, overlap or nearly touch, were never
/// seen side by side in one image, and one line explains the views of both. The merged line has all views and the
/// lowest id. Lines without an estimate stay as they are. Returns the number of lines that went.
int mergeLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params,
               std::vector<LineRecord>& lines);

}  // namespace lintel
