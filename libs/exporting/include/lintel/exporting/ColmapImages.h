// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "lintel/core/Frame.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

/// Writes the images of a map's keyframes as PNGs to `folder` (made if absent), under the names that a COLMAP model of
/// exportMap() refers to. `next` gives the recording's frames in order; empty at the end. Returns how many keyframes
/// found their image. `prepare`, if given, makes of an image what is written. Throws ExportError.
std::size_t writeColmapImages(const LineMap& map, const std::string& folder,
                              const std::function<std::optional<Frame>()>& next,
                              const std::function<GrayImage(const GrayImage&)>& prepare = {});

}  // namespace lintel
