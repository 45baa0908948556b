// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>

#include "TrackingStage.h"
#include "lintel/core/Rig.h"
#include "lintel/estimator/ClockOffset.h"

namespace lintel {

/// What the beginning of a recording says about the clocks of images and IMU.
struct ClockSearch {
  std::deque<TrackedFrame> frames;  ///< that the search has taken from tracking
  ClockOffset clock;                ///< the best determined one
  double offset_s = 0;  ///< to correct the stamps by; 0 where the images' stamps are good to some milliseconds
};

/// Looks at the tracks until the offset is determined, at most for five seconds in which the camera turns: before,
/// while it lies still, nothing shows the offset. It ends, too, when the images of more than five seconds take half a
/// gigabyte. Offsets that the estimator finds by itself, from its first frames on, are left to it. `cancelled` is asked
/// before every frame and may be empty.
ClockSearch searchClock(TrackingStage& tracking, const Rig& rig, const std::function<bool()>& cancelled = {});

}  // namespace lintel
