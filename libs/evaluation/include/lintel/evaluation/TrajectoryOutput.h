// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>

#include "lintel/evaluation/TrajectoryErrors.h"

namespace lintel {

/// The figures for a person to read.
void printText(const TrajectoryErrors& errors, std::ostream& out);

/// The figures as one JSON object; a figure that does not exist (no stretch that long) is null. Angles in radians.
std::string toJson(const TrajectoryErrors& errors);

}  // namespace lintel
