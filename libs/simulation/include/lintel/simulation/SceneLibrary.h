// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "lintel/simulation/FigureTrajectory.h"
#include "lintel/simulation/Scene.h"

namespace lintel {

/// What a scene is built around.
struct SceneRequest {
  Eigen::AlignedBox3d hull;           ///< inner size of the room [m], world
  std::vector<Eigen::Vector3d> path;  ///< positions flown through [m]: nothing is put nearer than `clearance_m`
  double clearance_m = 0.45;          ///< [m]
  std::uint64_t seed = 1;
};

/// A kind of scene: add one to the table in SceneLibrary.cpp.
struct SceneKind {
  std::string name;
  std::string description;
  Eigen::AlignedBox3d hull;  ///< its usual size [m]
  FigureParams figure;       ///< the figure that suits it
  Eigen::Vector3d margin_m;  ///< between the box round a given trajectory and the hull [m]
  Scene (*build)(const SceneRequest& request);
};

/// All kinds of scene.
const std::vector<SceneKind>& sceneKinds();

/// Throws std::invalid_argument, naming those that there are, for an unknown name.
const SceneKind& sceneKind(const std::string& name);

}  // namespace lintel
