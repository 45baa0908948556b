// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace lintel {

/// The stretch of a line that enough of its observations saw. `intervals`: (from, to) along the line [m], one per
/// observation; `share`: of the observations, at least two of them. From the first to the last well-covered place, so
/// that one observation that ran past the end does not lengthen the line. Empty when no place is covered well.
std::optional<std::pair<double, double>> coveredStretch(const std::vector<std::pair<double, double>>& intervals,
                                                        double share);

}  // namespace lintel
