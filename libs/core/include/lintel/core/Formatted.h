// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lintel {

/// A text made by the format and the values of printf(), of any length.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace lintel
