// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Moves the sightings of a rolling shutter to where they would be had all rows been exposed with the middle one: row v
/// is later by dt = (v - v_middle) line_delay_s. With the unit ray u of the pixel seen, the camera's angular rate w_c
/// and velocity v_c (its own axes, constant over the image), and the distance D of what is seen (infinite while
/// unknown),
///
///   ray = Exp(w_c dt) u + v_c dt / D
///
/// Everything that follows works with images taken at one time. Called when a frame has come, with the states as they
/// are known by then, so that sightings and states agree when these have settled. Nothing is done with a delay of 0.
void unroll(SlidingWindow& window, double line_delay_s);

}  // namespace lintel
