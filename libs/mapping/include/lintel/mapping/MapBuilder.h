// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "lintel/estimator/WindowUpdate.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapMaterial.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// Collects what leaves the window, for the map.
class MapBuilder {
 public:
  /// Throws std::invalid_argument, naming the parameter, when one is out of range.
  MapBuilder(const Rig& rig, const MapParams& params);

  /// Updates in the order of time. What a start has given that proved wrong is taken away again.
  void add(const WindowUpdate& update);

  /// Calibration that the map's poses belong to.
  void setCalibration(const Rig& rig, double time_offset_s = 0);

  /// All that was added, ordered, nothing left out; frames that a start was made of have poses as well.
  MapMaterial material() const;

  /// The same without a copy: the builder is empty afterwards.
  MapMaterial takeMaterial();

  /// The map of everything added so far: prepareMaterial(), then drawMap().
  LineMap build() const;

 private:
  /// How much of the material is of former starts.
  struct Extent {
    std::size_t keyframes = 0, points = 0, lines = 0, poses = 0;
  };

  void withdrawStart();

  MapParams params_;
  MapMaterial material_;
  std::vector<std::int64_t> frames_ns_;  ///< of all frames, with a pose or not
  Extent settled_;
};

/// Estimates all points and lines from all their views, with the poses as they are, and merges estimates of the same
/// landmark.
void prepareMaterial(const MapParams& params, MapMaterial& material);

/// After lines were added to a prepared material: joins those that are estimates of the same edge, also pieces of
/// opposite contrast, and constrains degenerate ones.
void settleLines(const MapParams& params, MapMaterial& material);

/// What a map keeps of the material that it was drawn from: keyframes, points and lines with the views that agree.
/// Lines are fitted to them.
MapMaterial materialOf(const MapParams& params, const LineMap& map);

/// The map of what has enough evidence: enough views that agree, known well enough, of some length. Ends are where they
/// were seen; parallel groups are named.
LineMap drawMap(const MapParams& params, const MapMaterial& material);

}  // namespace lintel
