// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineFitting.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Joins lines that are estimates of the same edge: pieces of it, and tracks of it with different identities. Two lines
/// are one when they are nearly parallel, close to each other, overlap or nearly touch, were never seen side by side in
/// one image, and one line explains the views of both. The merged line has all views and the lowest id. Lines without
/// an estimate stay as they are. Returns the number of lines that were joined to others.
///
/// `drift_px`: the same edge seen on a later pass may be off by so much, as the trajectory drifted in between. Such a
/// pair is joined only where it is unambiguous: the same side is the brighter one, and no third line that differs from
/// its partner lies nearly as close to either. An adjustment can then align the passes.
int mergeLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params, double drift_px,
               std::vector<LineRecord>& lines);

}  // namespace lintel
