// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lintel/geometry/Camera.h"
#include "lintel/geometry/Pose.h"
#include "lintel/simulation/Scene.h"

namespace lintel {

/// Light that fell on the sensor: row-major, width * height, linear; 1 is about a well-lit white wall.
using Radiance = std::vector<float>;

/// Rays through a pixel where surfaces meet, on a grid; rows times columns is a multiple of eight.
struct EdgeSampling {
  int rows = 4, columns = 4;
};

/// Ray-casts a scene through a camera: one ray a pixel with filtered textures, several where surfaces meet.
/// Deterministic; may be used from several threads at once.
class ImageRenderer {
 public:
  ImageRenderer(const Scene& scene, const Camera& camera);
  ~ImageRenderer();

  Radiance render(const Pose& T_w_c, const EdgeSampling& edges = {}) const;
  /// With a pose for each row, as a rolling shutter sees.
  Radiance render(const std::function<Pose(int row)>& T_w_c, const EdgeSampling& edges = {}) const;

  /// Per line of the scene: whether at least two of five points along it are in the image and not hidden.
  std::vector<bool> visibleLines(const Pose& T_w_c) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
