// SPDX-License-Identifier: BSD-3-Clause
#include "solver/LandmarkBlockDefinitions.h"

namespace lintel {

template <>
double LandmarkBlock<PointTarget>::addTie(const CameraLayout&, CameraEquations&) {
  return 0;
}
template <>
void LandmarkBlock<PointTarget>::eliminateTie(const Eigen::Vector3d&, const CameraLayout&, CameraEquations&) {}

template struct LandmarkBlock<PointTarget>;

}  // namespace lintel
