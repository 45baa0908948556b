// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <exception>

#include "lintel/estimator/ClockOffset.h"
#include "lintel/sensing/Recording.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// The beginning of a recording, read to find the clock offset of images and IMU.
struct ClockSearch {
  std::deque<FrameWithImu> read;  ///< to be processed still
  std::exception_ptr fault;       ///< why it could not be read on
  ClockOffset clock;              ///< the best determined one
  double offset_s = 0;  ///< to correct the stamps by; 0 where the images' stamps are good to some milliseconds
};

/// Follows points through the first seconds until the offset is determined, at most five seconds. Offsets that the
/// estimator finds by itself, from its first frames on, are left to it.
ClockSearch searchClock(Recording& recording, const FrontEndParams& tracking);

}  // namespace lintel
