// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include "lintel/mapping/DriftSpreading.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapMaterial.h"
#include "lintel/mapping/PointJoin.h"
#include "lintel/pipeline/Odometry.h"
#include "lintel/places/PlaceDescriber.h"

namespace lintel {

/// Describes frames while the flight lasts, and finds afterwards which of them show a place that was seen before.
class LoopStage {
 public:
  LoopStage(const Rig& rig, const PlaceParams& params);

  /// Frames in the order of time; those without a pose in the window, at rest, or too soon after another are left out.
  void add(const Frame& frame, const std::vector<PointObservation>& tracked, const WindowUpdate& update);

  /// The places; `progress` as for findPlaces(). Afterwards the stage has the descriptions that the map keeps.
  LoopResult find(const MapMaterial& material, const std::function<bool(double)>& progress);

  /// Where the odometry had the described frames.
  std::unordered_map<std::int64_t, Pose> cameras() const;

  /// Compares what the images say of the accepted pairs of one piece with the refined trajectory.
  void measureDrift(const MapMaterial& refined, LoopResult& loops) const;

  /// What the map keeps of the descriptions, for merging, with the tracks of its points. The stage has none left.
  std::vector<MapView> takeViews(const LineMap& map, const MapMaterial& material);

 private:
  bool isWanted(const WindowUpdate& update) const;
  void withdrawRun();
  void nameByPieces(const MapMaterial& material);
  void thinDescriptions();

  Rig rig_;
  PlaceParams params_;
  PlaceDescriber describer_;
  std::vector<std::unique_ptr<PlaceView>> views_;
  std::vector<PlaceKeyframe> frames_;
  int run_ = 0;  ///< of the estimator: each has a world of its own; after find() the piece of the material
  bool at_rest_ = false, searched_ = false;
};

/// The tracks that were found to be of one point, for the refinement.
std::vector<PointJoin> joinsOf(const LoopResult& loops);

/// What the accepted pairs say of where their later frames are; `odometry` has the cameras by their times, pieces and
/// pairs as they were before alignPieces().
std::vector<PlaceSighting> sightingsOf(const PlaceReport& places,
                                       const std::unordered_map<std::int64_t, Pose>& odometry);

/// Brings the pieces of a material that have places in common into one frame.
void alignPieces(const std::vector<RunAlignment>& alignments, MapMaterial& material);

}  // namespace lintel
