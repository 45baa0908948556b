// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Of a buffer that is to become longer without more frames: the frame without which those that remain are nearest to
/// each other, the oldest such; 0, the first one, where the buffer is long enough.
std::size_t frameToThinOut(const SlidingWindow& buffer);

/// Frame `k` leaves a buffer whose frames have no states yet, but not the newest; the IMU's samples before and after it
/// are joined.
void leaveOut(std::size_t k, SlidingWindow& buffer);

/// A buffer without the older half of its frames: where tracks are short its ends have nothing in common.
SlidingWindow newestHalf(SlidingWindow buffer);

}  // namespace lintel
