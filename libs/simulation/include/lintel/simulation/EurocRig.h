// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/Rig.h"

namespace lintel {

/// The rig of the EuRoC recordings: cam0 (752x480, 20 Hz) and the ADIS16448 (200 Hz) with its published noise.
Rig eurocRig();

/// A camera of the same size with another lens: for lenses that are not wide much the same field of view, for wide ones
/// 166 x 107 degrees.
Camera lensCamera(LensModel model);

}  // namespace lintel
