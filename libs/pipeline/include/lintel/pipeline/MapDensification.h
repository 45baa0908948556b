// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lintel/densification/Densifier.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/pipeline/Configuration.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

/// (t_ns, T_w_b), ascending times.
using PosesInTime = std::vector<std::pair<std::int64_t, Pose>>;

/// How a map is searched again.
struct MapDensificationOptions {
  Configuration configuration;  ///< `map` and `densification` count
  PosesInTime poses;            ///< of the body, in place of the map's, interpolated; empty: the map's own
  int threads = 1;
  std::function<void(std::size_t frames, std::size_t expected)> reading;
  DensifyProgress searching;
  std::function<bool()> cancelled;  ///< ends it: what was found so far is in the result
};

/// A map with what was found.
struct MapDensification {
  LineMap map;
  std::string refusal;  ///< why it cannot be searched, in words; empty: it was
  DensifyReport report;
  std::size_t keyframes_without_pose = 0;   ///< left out
  std::size_t keyframes_without_image = 0;  ///< not in the recording
};

/// Poses that do not belong to a map.
class PosesError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Searches the images of a map's keyframes for lines that it does not have (densify()). With other poses all points
/// and lines are estimated anew before. Throws PosesError when fewer than two keyframes have a pose.
MapDensification densifyMap(const LineMap& map, Recording& recording, const MapDensificationOptions& options);

}  // namespace lintel
