// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "SeenPoints.h"
#include "SegmentView.h"

namespace lintel {

/// The views that see the same points as one of them.
struct CommonViews {
  std::vector<std::size_t> all;     ///< ascending, itself too
  std::vector<std::size_t> chosen;  ///< at most `most` others, spread over where they were taken; the farthest first
};

/// The common views of each view. Sets the views' depths as well.
std::vector<CommonViews> findCommonViews(const SeenPoints& points, std::size_t most, std::vector<SegmentView>& views);

}  // namespace lintel
