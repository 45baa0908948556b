// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "EdgeStage.h"
#include "LoopStage.h"
#include "TrackingStage.h"
#include "lintel/mapping/MapBuilder.h"
#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// How the map is made. Progress is called with the share that is done; false ends it.
struct FinishOptions {
  int threads = 1;
  std::function<bool(double)> loops, refinement, densification;
};

/// Estimates a pose for every tracked frame, collects the map's material, and makes the map of it after the last frame.
class EstimationStage {
 public:
  EstimationStage(const Rig& rig, const Configuration& configuration, OdometryResult& result);

  /// Adds the frame to result and statistics.
  WindowUpdate process(const TrackedFrame& frame);

  /// Looks for places seen again and refines, unless the result is marked as cancelled, and draws the map.
  void finish(const FinishOptions& options);

 private:
  void finishMap(const FinishOptions& options);
  void keepForMerging(const MapMaterial& material);
  void refineMap(MapMaterial& material, const FinishOptions& options);
  void densifyMap(const MapParams& params, MapMaterial& material, const FinishOptions& options);
  void addPoses(const WindowUpdate& update);
  void withdrawStart();
  void count(const WindowUpdate& update);
  void leaveOutEnd();
  double secondsOf(std::int64_t t_ns) const;
  void countWindow(const WindowUpdate& update);
  void countBlind(bool blind, double t_s);

  Rig rig_;
  const Configuration& configuration_;
  Estimator estimator_;
  MapBuilder map_;
  LoopStage loops_;
  std::optional<EdgeStage> edges_;  ///< when the map is densified
  const BatchRefinement refinement_;
  OdometryResult& result_;
  std::map<std::string, std::size_t> waits_;  // frames by what initialisation waited for
  bool was_blind_ = false;
  std::optional<std::int64_t> interrupted_ns_;         ///< without a pose since then
  std::size_t settled_poses_ = 0, settled_blind_ = 0;  ///< of former starts
};

}  // namespace lintel
