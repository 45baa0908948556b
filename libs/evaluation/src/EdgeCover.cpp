// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeCover.h"

#include <algorithm>

#include "lintel/mapping/CommonKeyframes.h"

namespace lintel {

namespace {

constexpr double kApart_px = 2.5;  ///< between two lines of an image; MergeParams::min_separation_px has the same

/// Whether the images that show both show two lines: at least half of those in which they lie side by side.
bool areSeenAsTwo(const MapLine& a, const MapLine& b) {
  const SideBySide seen = sideBySide(a.observations, b.observations, &MapLineObservation::keyframe_id, kApart_px);
  return seen.apart > 0 && seen.apart >= seen.together;
}

}  // namespace

void EdgeCover::add(std::size_t edge_index, const MapLine& line, const Segment3& segment, const Segment3& edge) {
  const auto along = [&](const Eigen::Vector3d& p) {
    return std::clamp((p - edge.start).dot(edge.direction()), 0.0, edge.length());
  };
  const auto [from_m, to_m] = std::minmax({along(segment.start), along(segment.end)});
  if (to_m > from_m) stretches_[edge_index].push_back({from_m, to_m, &line});
}

/// Length of the union of all stretches, each piece counted once and again for every line that `countsAgain(line,
/// former line on this piece)` of any former line, over the union's length.
template <class CountsAgain>
double EdgeCover::times(const CountsAgain& countsAgain) const {
  double sum_m = 0, union_m = 0;
  for (const auto& [edge_index, stretches] : stretches_) {
    std::vector<double> bounds_m;
    for (const Stretch& s : stretches) bounds_m.insert(bounds_m.end(), {s.from_m, s.to_m});
    std::sort(bounds_m.begin(), bounds_m.end());
    for (std::size_t k = 0; k + 1 < bounds_m.size(); ++k) {
      const double length_m = bounds_m[k + 1] - bounds_m[k];
      if (length_m <= 0) continue;
      std::vector<const MapLine*> here;
      for (const Stretch& s : stretches) {
        if (s.from_m > bounds_m[k] || s.to_m < bounds_m[k + 1]) continue;
        if (here.empty()) union_m += length_m;
        if (here.empty() ||
            std::any_of(here.begin(), here.end(), [&](const MapLine* former) { return countsAgain(*s.line, *former); }))
          sum_m += length_m;
        here.push_back(s.line);
      }
    }
  }
  return sum_m / union_m;  // 0 / 0 is NaN: no length
}

double EdgeCover::duplicates() const {
  return times([](const MapLine&, const MapLine&) { return true; });
}

double EdgeCover::trueDuplicates() const {
  return times([](const MapLine& a, const MapLine& b) { return !areSeenAsTwo(a, b); });
}

}  // namespace lintel
