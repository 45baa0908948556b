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

/// Of a landmark's views, this many are fitted to; all are judged. In minutes at one place it gets thousands.
constexpr std::size_t kMostFitted = 200;

/// Leaves `most` of the things, evenly spread over all with the first and the last: the hundredth view of a landmark
/// adds little information. Below 2: all stay.
template <class Thing>
void thinOut(std::vector<Thing>& things, std::size_t most) {
  if (most < 2 || things.size() <= most) return;
  for (std::size_t i = 0; i < most; ++i) things[i] = things[i * (things.size() - 1) / (most - 1)];
  things.erase(things.begin() + static_cast<std::ptrdiff_t>(most), things.end());
}

}  // namespace lintel
