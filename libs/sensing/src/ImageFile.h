// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/core/Frame.h"

namespace lintel {

/// Decodes an image file to 8-bit grey. Throws ImageFault when it is missing, cut or no image.
GrayImage readGrayImage(const std::string& path);

}  // namespace lintel
