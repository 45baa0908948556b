// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

namespace lintel {

/// lintel-vio, the main job: a recording in, trajectory and line map out. Returns the exit code: 0 done, 1 bad
/// recording, configuration or output folder, or no pose at all (one line on `err`; what was computed is written),
/// 2 wrong command line.
int runLintelVio(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace lintel
