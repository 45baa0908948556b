// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <assimp/scene.h>

#include <memory>
#include <string>

#include "Drawing.h"

namespace lintel {

/// The drawing as an assimp scene: a root node "Map" that turns z-up to y-up, below it the nodes Lines (a child per
/// group), Points, Keyframes, Trajectory, each with a mesh of vertex-coloured lines, points or tubes' triangles.
std::unique_ptr<aiScene> makeAssimpScene(const Drawing& drawing);

/// Runs assimp's exporter of that name and returns the file it makes. Throws ExportError naming `path`.
std::string exportByAssimp(const aiScene& scene, const std::string& format, const std::string& path);

}  // namespace lintel
