// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"

namespace lintel {

/// Writes `frame` with its tracks as a PNG to `path` (beside it first, then renamed): points as dots, lines as curves
/// through the lens, each identity in a colour of its own that stays over frames, lines with their number; lines that
/// the detector does not see in this frame are dashed. Throws std::runtime_error naming the file when it cannot be
/// written.
void drawTracks(const std::string& path, const Frame& frame, const Rig& rig, const FrameTracks& tracks);

}  // namespace lintel
