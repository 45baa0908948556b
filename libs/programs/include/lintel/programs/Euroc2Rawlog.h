// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace lintel {

/// The program euroc2rawlog: writes an EuRoC folder as an MRPT rawlog. Returns the exit code (0 done, 1 bad input or
/// output, 2 usage); the summary goes to `out`, progress, warnings and the one line about what went wrong to `err`.
int runEuroc2Rawlog(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace lintel
