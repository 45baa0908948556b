// SPDX-License-Identifier: BSD-3-Clause
#include "TrackBook.h"

#include <algorithm>

namespace lintel {

std::vector<TrackBook::Entry> TrackBook::update(const std::vector<std::size_t>& seen,
                                                std::vector<std::size_t>& landmark_of_track) {
  std::map<std::size_t, Entry> now;
  for (const std::size_t landmark : seen) {
    const auto known = tracks_.find(landmark);
    if (known != tracks_.end()) now.emplace(landmark, known->second);
  }
  for (const std::size_t landmark : seen) {
    if (now.size() >= capacity_) break;
    if (now.emplace(landmark, Entry{landmark_of_track.size(), landmark, 0}).second)
      landmark_of_track.push_back(landmark);
  }
  tracks_ = std::move(now);
  std::vector<Entry> entries;
  for (auto& [landmark, entry] : tracks_) {
    ++entry.length;
    entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.id < b.id; });
  return entries;
}

}  // namespace lintel
