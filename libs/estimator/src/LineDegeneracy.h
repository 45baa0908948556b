// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "lintel/geometry/PluckerLine.h"

namespace lintel {

/// How well a line is known: standard deviations from its 4x4 information in the tangent space of LineManifold.
struct LineUncertainty {
  double direction_rad = 0;  ///< worst direction error
  double distance_m = 0;     ///< worst displacement across the line, at the point `along_m` from its foot
};

/// `information`: J^T J of its observations; `along_m`: signed distance along d from the point nearest to the moment's
/// origin to the middle of what was seen. Unobserved directions give infinity.
LineUncertainty uncertaintyOf(const OrthonormalLine& line, const Eigen::Matrix4d& information, double along_m);

}  // namespace lintel
