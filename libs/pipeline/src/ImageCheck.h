// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lintel/core/Frame.h"

namespace lintel {

/// Looks for images that cannot be what a camera sees: without any contrast, or the same as the one before while the
/// IMU turns.
class ImageCheck {
 public:
  /// A frame and the IMU since the one before.
  void add(const FrameWithImu& step);

  double blankShare() const { return share(blank_); }
  double repeatedShare() const { return share(repeated_); }

  /// What is wrong with more than a tenth of the images, in words; empty when nothing is.
  std::string fault() const;

 private:
  double share(int count) const { return images_ > 0 ? static_cast<double>(count) / images_ : 0; }

  int images_ = 0, blank_ = 0, repeated_ = 0;
  std::vector<std::uint8_t> before_, sampled_;
};

}  // namespace lintel
