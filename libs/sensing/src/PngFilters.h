// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lintel {

/// Takes back the filters of a PNG with one byte a pixel ([PNG] section 9). `rows`: `height` rows of one byte that
/// names the filter and `width` bytes. False where a row names none of the five filters.
bool unfilterGray(const std::uint8_t* rows, std::size_t width, std::size_t height, std::vector<std::uint8_t>& pixels);

}  // namespace lintel
