// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "lintel/mapping/BatchRefinement.h"
#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// Which landmarks of a material take part in an adjustment, and with how many views.
struct AdjustedLandmarks {
  std::vector<bool> points, lines;
  std::size_t most_views = 0;  ///< of a landmark that have residuals; 0: all
};

/// Those that are known well enough, as far as all together keep to `most_residuals`.
AdjustedLandmarks landmarksToAdjust(const MapMaterial& material, const RefinementParams& params);

}  // namespace lintel
