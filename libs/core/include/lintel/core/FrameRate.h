// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace lintel {

/// The rate of EuRoC's images, for which the defaults were chosen [Hz].
constexpr double kReferenceRate_hz = 20;

/// A number of frames that stands for a time is given for images at kReferenceRate_hz: as many take that time at
/// another rate, at least one. 0 stays 0.
inline int framesAtRate(int reference_frames, double rate_hz) {
  if (reference_frames <= 0) return reference_frames;
  return std::max(1, static_cast<int>(std::lround(reference_frames * rate_hz / kReferenceRate_hz)));
}

}  // namespace lintel
