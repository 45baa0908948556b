// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

/// Takes out the tracks that can add nothing any more once frame `leaving` is gone (not seen in the newest frame and
/// fewer than two other sightings left) and hands those with an estimate to `update`.
void retireTracks(SlidingWindow& window, FrameId leaving, bool keyframe, WindowUpdate& update);

/// Hands over frame `k` as a keyframe.
void retireKeyframe(const SlidingWindow& window, std::size_t k, WindowUpdate& update);

/// Hands over every frame and every track with an estimate, and empties the window.
void retireAll(SlidingWindow& window, WindowUpdate& update);

}  // namespace lintel
