// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LoopStage.h"
#include "TrackingStage.h"
#include "lintel/mapping/MapBuilder.h"
#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// Estimates a pose for every tracked frame, collects the map's material, and makes the map of it after the last frame.
class EstimationStage {
 public:
  EstimationStage(const Rig& rig, const Configuration& configuration, OdometryResult& result);

  /// Adds the frame to result and statistics.
  WindowUpdate process(const TrackedFrame& frame);

  /// Looks for places seen again and refines, unless the result is marked as cancelled, and draws the map.
  void finish(const RefinementProgress& loops_progress, const RefinementProgress& progress);

 private:
  void finishMap(const RefinementProgress& loops_progress, const RefinementProgress& progress);
  void refineMap(MapMaterial& material, const RefinementProgress& loops_progress, const RefinementProgress& progress);
  void count(const WindowUpdate& update);
  void countWindow(const WindowUpdate& update);
  void countBlind(bool blind, double t_s);

  Rig rig_;
  const Configuration& configuration_;
  Estimator estimator_;
  MapBuilder map_;
  LoopStage loops_;
  const BatchRefinement refinement_;
  OdometryResult& result_;
  bool was_blind_ = false;
};

}  // namespace lintel
