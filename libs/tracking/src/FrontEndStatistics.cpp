// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/tracking/FrontEndStatistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lintel/core/Quantiles.h"

namespace lintel {

double StageTimes::sum() const { return std::accumulate(ms.begin(), ms.end(), 0.0); }

double StageTimes::mean() const { return ms.empty() ? 0.0 : sum() / static_cast<double>(ms.size()); }

double StageTimes::quantile(double q) const {
  if (ms.empty()) return 0;
  std::vector<float> values = ms;
  return lowerQuantile(values, std::clamp(q, 0.0, 1.0));
}

std::int64_t TrackLifetimes::count() const {
  return std::accumulate(ended.begin(), ended.end(), std::int64_t{0},
                         [](std::int64_t sum, const auto& entry) { return sum + entry.second; });
}

double TrackLifetimes::shareOfAtLeast(int frames) const {
  const std::int64_t all = count();
  std::int64_t long_ones = 0;
  for (auto it = ended.lower_bound(frames); it != ended.end(); ++it) long_ones += it->second;
  return all == 0 ? 0.0 : static_cast<double>(long_ones) / static_cast<double>(all);
}

double TrackLifetimes::median() const {
  const std::int64_t all = count();
  std::int64_t below = 0;
  for (const auto& [frames, tracks] : ended) {
    below += tracks;
    if (2 * below >= all) return frames;
  }
  return 0;
}

}  // namespace lintel
