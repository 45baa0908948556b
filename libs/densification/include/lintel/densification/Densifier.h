// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "lintel/densification/DensifyParams.h"
#include "lintel/mapping/MapMaterial.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// The edges of images, by their times.
using ImageEdges = std::map<std::int64_t, std::vector<EdgeSegment>>;

/// What a search has found.
struct DensifyReport {
  std::size_t images = 0, segments = 0;  ///< searched
  std::size_t views = 0;                 ///< added to lines that the map had
  int lines = 0;                         ///< added, before merging
};

/// Called now and then with the share that is done, in [0, 1]; false ends the search: what was found stays.
using DensifyProgress = std::function<bool(double)>;

/// Adds lines to `material` that tracking has missed: edges of its keyframes' images that no line of the map explains
/// are paired between keyframes, and a pair's line is kept when the images of enough other keyframes have an edge where
/// it is projected. Poses and points stay; lines of the map get the views that tracking missed. The same result with
/// any number of threads. Afterwards settleLines() has to follow.
DensifyReport densify(const DensifyParams& params, const MapParams& map, const ImageEdges& edges, MapMaterial& material,
                      int threads = 1, const DensifyProgress& progress = {});

}  // namespace lintel
