// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace lintel {

/// The program lintel-bench: recordings × configurations → tables. Returns the exit code (0 done, 1 bad input or a run
/// that failed, 2 usage); tables go to `out`, progress and what went wrong to `err`.
int runLintelBench(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace lintel
