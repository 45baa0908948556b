// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lintel/core/Frame.h"

namespace lintel {

/// Decodes the bytes of a PNG file with 8-bit grey pixels: what cameras of EuRoC write, in less than half of libpng's
/// time. Empty for every other kind of image, and for one that is damaged.
std::optional<GrayImage> decodeGrayPng(const std::vector<std::uint8_t>& file);

/// Whether a file is a PNG of any kind, but cut or changed: libpng would complain about it on the standard error
/// output.
bool isDamagedPng(const std::vector<std::uint8_t>& file);

}  // namespace lintel
