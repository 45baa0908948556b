// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "RayCaster.h"
#include "lintel/simulation/Scene.h"

namespace lintel {

/// The light on one patch: a coarse grid computed once, soft shadows included.
class LightMap {
 public:
  LightMap(const Scene& scene, const Patch& patch, const RayCaster& rays);

  /// Irradiance at (a, b) of the patch, bilinear.
  float at(float a, float b) const;

 private:
  int columns_, rows_;
  std::vector<float> values_;
};

}  // namespace lintel
