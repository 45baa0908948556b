// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Moves the sightings of a rolling shutter to where they would be had all rows been exposed with the middle one: row v
/// is later by dt = (v - v_middle) / height readout. With the unit ray u of the pixel seen, the camera's angular rate
/// w_c and velocity v_c (its own axes, constant over the image), and the distance D of what is seen (infinite while
/// unknown),
///
///   ray = Exp(w_c dt) u + v_c dt / D
///
/// Everything that follows works with images taken at one time; residuals of points know by RowTime what the
/// readout was taken for. Called when a frame has come, with the states as they are known by then, so that sightings
/// and states agree when these have settled. A readout that is too short to matter counts as none.
void unroll(SlidingWindow& window);

}  // namespace lintel
