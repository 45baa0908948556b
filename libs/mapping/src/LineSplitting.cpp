// SPDX-License-Identifier: BSD-3-Clause
#include "LineSplitting.h"

#include <algorithm>
#include <map>

namespace lintel {

namespace {

/// The tracks of a line that it does not explain; never all of them.
std::vector<TrackId> strangers(const LineRecord& line) {
  struct Count {
    int views = 0, inliers = 0;
  };
  std::map<TrackId, Count> counts;
  for (const LineView& v : line.views) ++counts[v.track].views, counts[v.track].inliers += v.inlier;
  std::vector<TrackId> result;
  for (const auto& [track, count] : counts)
    if (2 * count.inliers < count.views) result.push_back(track);
  if (result.size() == counts.size()) result.clear();
  return result;
}

}  // namespace

int splitLines(std::vector<LineRecord>& lines) {
  TrackId next = 0;
  for (const LineRecord& line : lines) next = std::max(next, line.id + 1);
  std::vector<LineRecord> separate;
  for (LineRecord& line : lines) {
    if (!line.known) continue;
    for (const TrackId track : strangers(line)) {
      const auto others = std::stable_partition(line.views.begin(), line.views.end(),
                                                [&](const LineView& v) { return v.track != track; });
      LineRecord alone;
      alone.id = next++;
      alone.parallel = line.parallel;
      alone.views.assign(others, line.views.end());
      line.views.erase(others, line.views.end());
      separate.push_back(std::move(alone));
    }
  }
  const auto count = static_cast<int>(separate.size());
  std::move(separate.begin(), separate.end(), std::back_inserter(lines));
  return count;
}

}  // namespace lintel
