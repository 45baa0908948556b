// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "lintel/core/FrameTracks.h"

namespace lintel {

/// Gives landmarks that stay in view the same track id from frame to frame, and a new one when they come back.
class TrackBook {
 public:
  struct Entry {
    TrackId id = 0;
    std::size_t landmark = 0;
    int length = 0;
  };

  /// At most `capacity` tracks at a time.
  explicit TrackBook(int capacity) : capacity_(static_cast<std::size_t>(capacity)) {}

  /// One frame: `seen` are the landmarks in view, ascending. New ids are appended to `landmark_of_track`. Ascending
  /// ids.
  std::vector<Entry> update(const std::vector<std::size_t>& seen, std::vector<std::size_t>& landmark_of_track);

 private:
  std::size_t capacity_;
  std::map<std::size_t, Entry> tracks_;  // by landmark
};

}  // namespace lintel
