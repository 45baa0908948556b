// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lintel/mapping/BatchRefinement.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/pipeline/Configuration.h"
#include "lintel/places/PlaceSearch.h"

namespace lintel {

/// How maps are merged.
struct MapMergingOptions {
  Configuration configuration;  ///< `estimator`, `map`, `loops` and `refinement` count
  /// Called with the share that is done; false ends it.
  std::function<bool(double)> searching, refining;
};

/// Two maps in one frame, that of the first.
struct MapMerging {
  LineMap map;
  std::string refusal;           ///< why they are not merged, in words; empty: they are
  std::vector<PlacePair> pairs;  ///< of keyframes of both that show the same place; accepted and refused
  RefinementReport refinement;
};

/// Merges two maps of one camera: finds places that both show, moves the second into the frame of the first, joins the
/// points that both have tracked, and adjusts all keyframes of both together. Pieces of either that have no place in
/// common with the others keep a world of their own. Both maps need their views and the IMU (loops.keep_interval_s).
MapMerging mergeMaps(const LineMap& first, const LineMap& second, const MapMergingOptions& options);

/// The trajectory of one of the recordings of a map, by its place in LineMap::recordings.
std::vector<std::pair<std::int64_t, Pose>> trajectoryOf(const LineMap& map, int recording);

}  // namespace lintel
