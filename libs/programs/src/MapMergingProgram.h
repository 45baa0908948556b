// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace lintel {

/// `lintel-map merge …`; `argv[0]` is the name of the program with that word. Returns the exit code; throws as other
/// programs do (programMain).
int mergeFromCommandLine(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace lintel
