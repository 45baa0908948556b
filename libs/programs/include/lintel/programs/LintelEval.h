// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace lintel {

/// The program lintel-eval: errors of a trajectory against its ground truth, and of a line map
/// against the true lines. Returns the exit code (0 done, 1 bad
/// input, 2 usage); figures go to `out`, one line about what went wrong to `err`.
int runLintelEval(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace lintel
