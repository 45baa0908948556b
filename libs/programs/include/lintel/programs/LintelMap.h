// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace lintel {

/// lintel-map: writes a native map file in a form that other programs open. Returns the exit code: 0 done, 1 unreadable
/// map or unwritable file (one line on `err`), 2 wrong command line.
int runLintelMap(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace lintel
