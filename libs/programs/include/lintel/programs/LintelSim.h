// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace lintel {

/// The program lintel-sim: a simulated recording with everything true about it. Returns the exit code (0 done, 1 bad
/// input, 2 usage); the summary goes to `out`, progress and one line about what went wrong to `err`.
int runLintelSim(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace lintel
