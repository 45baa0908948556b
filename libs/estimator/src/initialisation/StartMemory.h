// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/FrameTracks.h"

namespace lintel {

/// The last frames as they came in, for a start that replaces a wrong one.
class StartMemory {
 public:
  /// A window frame.
  struct Input {
    FrameTracks tracks;
    ImuBatch imu;  ///< since the window frame before
  };

  /// Keeps the last `most` window frames.
  void add(const FrameTracks& tracks, const ImuBatch& imu, std::size_t most);

  /// A frame between window frames, in any order; of these all since the first window frame that is kept here, or since
  /// `from_ns`.
  void addSkipped(std::int64_t t_ns, std::int64_t from_ns);

  void clear();

  const std::deque<Input>& inputs() const { return inputs_; }
  std::vector<std::int64_t> skippedBetween(std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  std::deque<Input> inputs_;
  std::deque<std::int64_t> skipped_ns_;
};

}  // namespace lintel
