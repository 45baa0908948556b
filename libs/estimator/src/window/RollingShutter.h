// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Moves the sightings of a rolling shutter to where they would be had all rows been exposed with the middle one: row v
/// is later by dt = (v - v_middle) / height readout. Points by RowMotion, with their distance as far as it is known and
/// that of most points else; lines so that they fit the whole moved edge. The accelerations are those that the IMU
/// shows around the image.
///
/// Everything that follows works with images taken at one time; residuals of points know by RowTime what the
/// readout was taken for. Called when a frame has come, with the states as they are known by then, so that sightings
/// and states agree when these have settled. A readout that is too short to matter counts as none.
void unroll(SlidingWindow& window);

}  // namespace lintel
