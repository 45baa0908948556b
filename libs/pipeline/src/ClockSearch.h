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
  double offset_s = 0;              ///< to correct the stamps by; 0 where they are likely to be right
  double sigma_s = 0;               ///< of what remains then
};

/// Looks at the tracks until the offset is determined, at most for five seconds in which the camera turns: before,
/// while it lies still, nothing shows the offset. It ends, too, when the images of more than five seconds take half a
/// gigabyte. `stamp_sigma_s` is the standard deviation of the offset where the stamps are right, as most recordings'
/// are. `cancelled` is asked before every frame and may be empty.
ClockSearch searchClock(TrackingStage& tracking, const Rig& rig, double stamp_sigma_s,
                        const std::function<bool()>& cancelled = {});

}  // namespace lintel
