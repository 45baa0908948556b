// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/SlidingWindow.h"
#include "lintel/inertial/StampJitter.h"

namespace lintel {

InertialState stateOf(const WindowFrame& frame);

/// Where the body was when an image was taken whose state this is: later by what the window knows of the offset between
/// the clocks. `gyro` is the angular rate there, bias included [rad/s].
Pose poseOfImage(const SlidingWindow& window, const InertialState& state, const Eigen::Vector3d& gyro);

/// What a window's intervals from `first` on, each that of a frame with the one before, say of the images' stamps.
void addIntervals(const SlidingWindow& window, std::size_t first, StampJitter& jitter);

/// Stamps that are off by `sigma_s` become noise of the window's IMU, at the states as they are.
void countStampJitter(double sigma_s, SlidingWindow& window);

}  // namespace lintel
