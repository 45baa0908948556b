// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// Throws std::invalid_argument that names the first value out of range.
void checkParams(const Rig& rig, const FrontEndParams& params);

/// Throws std::invalid_argument when the image is missing or not of the rig's size.
void checkFrame(const Rig& rig, const Frame& frame);

}  // namespace lintel
