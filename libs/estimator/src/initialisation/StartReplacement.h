// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "initialisation/StartMemory.h"
#include "lintel/estimator/SlidingWindow.h"
#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

/// The window frames before the newest that a wrong start, whose first pose was at `from_ns`, had given poses for.
std::vector<const WindowFrame*> framesToReplace(const SlidingWindow& window, std::int64_t from_ns);

/// Adds the poses of `frames` (of the window, in order of time, with their covariances) to those that `update`
/// replaces, and those of the frames between window frames that `memory` knows of, as the IMU carries the state before
/// to them.
void replacePoses(const SlidingWindow& window, const std::vector<const WindowFrame*>& frames,
                  const std::vector<StateCovariance>& covariances, const StartMemory& memory, WindowUpdate& update);

}  // namespace lintel
