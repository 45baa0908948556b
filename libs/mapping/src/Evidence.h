// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "lintel/mapping/MapMaterial.h"

namespace lintel {

/// Views that agree with a point's or line's estimate.
template <class Record>
int inliersOf(const Record& record) {
  return static_cast<int>(
      std::count_if(record.views.begin(), record.views.end(), [](const auto& v) { return v.inlier; }));
}

/// Different keyframes among the inliers.
inline int keyframesOf(const LineRecord& line) {
  std::vector<FrameId> ids;
  for (const LineView& v : line.views)
    if (v.inlier) ids.push_back(v.keyframe);
  std::sort(ids.begin(), ids.end());
  return static_cast<int>(std::unique(ids.begin(), ids.end()) - ids.begin());
}

}  // namespace lintel
