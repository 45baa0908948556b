// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/Rig.h"

namespace lintel {

/// The rig of the EuRoC recordings: cam0 (752x480, 20 Hz) and the ADIS16448 (200 Hz) with its published noise.
Rig eurocRig();

}  // namespace lintel
