// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/PlaceView.h"

namespace lintel {

/// Number of bits in which two descriptors differ.
int hammingDistance(const PlaceDescriptor& a, const PlaceDescriptor& b);

}  // namespace lintel
