// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lintel/places/PlaceSearch.h"

namespace lintel {

/// Two keyframes of different runs that show the same place.
struct RunPair {
  int earlier_run = 0, later_run = 0;
  std::size_t later = 0;                                  ///< keyframe
  Pose earlier_from_later;                                ///< the worlds of the runs, as this pair has them
  Eigen::Vector3d p_later;                                ///< where the later camera was, in its own world
  double distance_m = 0;                                  ///< of the points
  double earlier_travelled_m = 0, later_travelled_m = 0;  ///< before the two keyframes
  std::string refusal;                                    ///< why it is not believed
};

/// How the worlds of runs lie in one another, from pairs of keyframes: yaw and position, since all know the vertical.
/// Of the pairs of two runs those must agree that keyframes of `min_keyframes` are in, and twice as many as agree on
/// anything else. `possible(earlier run, later run, earlier_from_later)` says whether the flight allows it. Runs that
/// hang together, the best-founded pairs first, share the world of the first of them. Pairs that contradict get a
/// refusal.
std::vector<RunAlignment> alignRuns(std::vector<RunPair>& pairs, int min_keyframes,
                                    const std::function<bool(int, int, const Pose&)>& possible);

}  // namespace lintel
