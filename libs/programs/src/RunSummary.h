// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "lintel/pipeline/Odometry.h"

namespace lintel {

struct WrittenRun {
  std::string output;                 ///< the folder
  std::vector<std::string> exported;  ///< files of the map
  double wall_s = 0;                  ///< what the run took
};

/// What `lintel-vio` says at the end: whether the run may be trusted, how far it went, what was written and how to look
/// at it.
void summarise(const OdometryResult& result, const WrittenRun& written, std::ostream& out);

}  // namespace lintel
