// SPDX-License-Identifier: BSD-3-Clause
#include "LineSplitting.h"

#include <algorithm>
#include <map>

namespace lintel {

namespace {

/// The tracks of a line most of whose views are outliers; never all of them.
std::vector<TrackId> unexplainedTracks(const LineRecord& line) {
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
    for (const TrackId track : unexplainedTracks(line)) {
      const auto others = std::stable_partition(line.views.begin(), line.views.end(),
                                                [&](const LineView& v) { return v.track != track; });
      LineRecord split;
      split.id = next++;
      split.parallel = line.parallel;
      split.views.assign(others, line.views.end());
      line.views.erase(others, line.views.end());
      separate.push_back(std::move(split));
    }
  }
  const auto count = static_cast<int>(separate.size());
  std::move(separate.begin(), separate.end(), std::back_inserter(lines));
  return count;
}

}  // namespace lintel
