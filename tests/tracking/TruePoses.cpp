// SPDX-License-Identifier: BSD-3-Clause
#include "TruePoses.h"

#include <algorithm>
#include <iterator>

#include "lintel/sensing/GroundTruth.h"

namespace lintel::truth {

TruePoses::TruePoses(const std::string& recording) : poses_(readGroundTruth(recording)) {}

std::optional<Pose> TruePoses::at(std::int64_t t_ns) const {
  constexpr std::int64_t kBeyond_ns = 6'000'000;
  if (empty() || t_ns < poses_.front().first - kBeyond_ns || t_ns > poses_.back().first + kBeyond_ns)
    return std::nullopt;
  const auto after = std::lower_bound(std::next(poses_.begin()), std::prev(poses_.end()), t_ns,
                                      [](const auto& pose, std::int64_t t) { return pose.first < t; });
  const auto before = std::prev(after);
  const double share = static_cast<double>(t_ns - before->first) / static_cast<double>(after->first - before->first);
  return interpolate(before->second, after->second, std::clamp(share, 0.0, 1.0));
}

}  // namespace lintel::truth
