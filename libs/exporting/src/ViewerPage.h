// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace lintel {

/// page/viewer.html, with the marks [[TITLE]], [[DATA]], [[THREE]], [[CONTROLS]] and [[WIDE_LINES]] to be
/// filled; made by CMake.
extern const std::string_view kViewerPage;

/// Where Debian's libjs-three keeps three.js.
extern const char* const kThreeFolder;

}  // namespace lintel
