// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "TwoViewMotion.h"
#include "lintel/core/CameraTurn.h"

namespace lintel {

/// Rotation between two views from points alone, whatever a gyroscope says; without times. A camera that moves along a
/// wall and one that turns before it see nearly the same, and the fit has a minimum at either: it begins with the
/// rotation that explains most of the points' motion when nothing is translated, and with none. The better one counts,
/// and where it is not clearly better its standard deviations cover the other. Empty when there are fewer than 15
/// pairs, or half of them fit no common motion. Of `camera` focal length and kind of rays count.
std::optional<CameraTurn> turnOfPoints(const std::vector<TwoViewPair>& pairs, const TwoViewParams& camera);

}  // namespace lintel
