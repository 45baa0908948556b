// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "LineExtent.h"

namespace lintel {

/// `stretch` of a line without what lies beyond a place where most of the views that end at all agree that the line
/// ends, when fewer than `share` of the views go past it and none of these but one sees it finer than half of the
/// others: in the image another edge goes on there, a wall's where a ceiling's ends. Ends are alike within six pixels.
std::pair<double, double> withinAgreedEnds(const std::vector<SeenPiece>& pieces, double share,
                                           std::pair<double, double> stretch);

}  // namespace lintel
