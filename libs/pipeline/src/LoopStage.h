// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

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

  /// The places; `progress` as for findPlaces().
  LoopResult find(const MapMaterial& material, const std::function<bool(double)>& progress) const;

  /// Compares what the images say of the accepted pairs with the refined trajectory.
  void measureDrift(const MapMaterial& refined, LoopResult& loops) const;

 private:
  bool isWanted(const WindowUpdate& update) const;
  void withdrawRun();

  Rig rig_;
  PlaceParams params_;
  PlaceDescriber describer_;
  std::vector<std::unique_ptr<const PlaceView>> views_;
  std::vector<PlaceKeyframe> frames_;
  int run_ = 0;  ///< of the estimator: each has a world of its own
  bool at_rest_ = false;
};

/// The tracks that were found to be of one point, for the refinement.
std::vector<PointJoin> joinsOf(const LoopResult& loops);

}  // namespace lintel
