// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/inertial/TurnCheck.h"

namespace lintel {

/// What the calibration (or a unit, or the order of axes) has to be wrong about for a camera to turn as in `fit`, in
/// words; empty when all may be right, or the flight has not turned enough to tell.
std::string faultOf(const TurnFit& fit, const Eigen::Quaterniond& R_b_c, Suspicion suspicion);

}  // namespace lintel
