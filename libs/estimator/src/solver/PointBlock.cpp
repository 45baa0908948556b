// SPDX-License-Identifier: BSD-3-Clause
#include "solver/LandmarkBlockDefinitions.h"

namespace lintel {

template <>
double LandmarkBlock<PointTarget>::addTie(const CameraLayout&, CameraEquations&) {
  return 0;
}

template struct LandmarkBlock<PointTarget>;

}  // namespace lintel
