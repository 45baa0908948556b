// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/StartMemory.h"

#include <algorithm>

namespace lintel {

void StartMemory::add(const FrameTracks& tracks, const ImuBatch& imu, std::size_t most) {
  inputs_.push_back({tracks, imu});
  if (inputs_.size() > most) inputs_.pop_front();
}

void StartMemory::addSkipped(std::int64_t t_ns, std::int64_t from_ns) {
  skipped_ns_.insert(std::upper_bound(skipped_ns_.begin(), skipped_ns_.end(), t_ns), t_ns);
  if (!inputs_.empty()) from_ns = std::min(from_ns, inputs_.front().tracks.t_ns);
  while (skipped_ns_.front() < std::min(from_ns, t_ns)) skipped_ns_.pop_front();
}

void StartMemory::clear() {
  inputs_.clear();
  skipped_ns_.clear();
}

std::vector<std::int64_t> StartMemory::skippedBetween(std::int64_t from_ns, std::int64_t to_ns) const {
  return {std::upper_bound(skipped_ns_.begin(), skipped_ns_.end(), from_ns),
          std::lower_bound(skipped_ns_.begin(), skipped_ns_.end(), to_ns)};
}

}  // namespace lintel
