// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// Why the window cannot be trusted any more, in words; empty when it can. `predicted`: the newest pose before the
/// images were used. [Qin2018, failure detection]
std::string findFailure(const SlidingWindow& window, const FailureParams& params, const Pose& predicted_T_w_b);

/// Whether the points that move in the images, by more than the rotation explains, have places that fit the estimated
/// motion. Where the scale has run away, or the images have lost their say against the IMU, they have none: what is
/// triangulated is rejected with the next frames, while states and biases look plausible.
class PlacementCheck {
 public:
  /// After a solve.
  void add(const SlidingWindow& window);

  /// Most of them have had none for some window frames, and neither have most of all points: where the camera hardly
  /// moves, points of noise that slide are the only ones that do. (For one window frame that is so when a vehicle takes
  /// off from rest.) A start on trial, for which another one costs little, is given up sooner and for the former alone.
  bool contradicted(bool on_trial) const;

 private:
  struct Count {
    int points = 0, placed = 0;
    int moving = 0, moving_placed = 0;  // of them
  };
  std::deque<Count> counts_;  // of the last window frames
  int moving_frames_ = 0;     // in a row after which most that move had none
  int frames_ = 0;            // the same, and most of all
};

}  // namespace lintel
