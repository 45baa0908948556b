// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "lintel/evaluation/Consistency.h"
#include "lintel/evaluation/LineConsistency.h"
#include "lintel/evaluation/LineErrors.h"
#include "lintel/evaluation/TrajectoryErrors.h"

namespace lintel {

/// The figures for a person to read; "-" for a figure that does not exist.
void printText(const TrajectoryErrors& errors, std::ostream& out);
void printText(const LineErrors& errors, std::ostream& out);
void printText(const Consistency& consistency, std::ostream& out);
void printText(const LineConsistency& consistency, std::ostream& out);

/// The figures as a JSON object with the members "trajectory", "map_trajectory" (the one that the map was aligned by),
/// "lines", "consistency" and "line_sigmas", as far as given. A figure that does not exist (no stretch that long) is
/// null. Angles in radians.
std::string toJson(const std::optional<TrajectoryErrors>& trajectory,
                   const std::optional<TrajectoryErrors>& map_trajectory, const std::optional<LineErrors>& lines,
                   const std::optional<Consistency>& consistency = {},
                   const std::optional<LineConsistency>& line_sigmas = {});

}  // namespace lintel
