// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LineFitting.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Makes one line of those that are the same: pieces of one edge, and what was lost and seen again under another
/// identity. Two lines are one when they are nearly parallel, close to each other, overlap or nearly touch, were never
/// seen side by side in one image, and one line explains the views of both. The merged line has all views and the
/// lowest id. Lines without an estimate stay as they are. Returns the number of lines that went.
///
/// `drift_px`: what was seen again on a later pass may be off by so much, as the trajectory drifted in between. Such a
/// pair is joined only where nothing else could be meant: the same side is the brighter one, and no third line that is
/// another one than its partner lies nearly as close to either. An adjustment can then move the passes together.
int mergeLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params, double drift_px,
               std::vector<LineRecord>& lines);

}  // namespace lintel
