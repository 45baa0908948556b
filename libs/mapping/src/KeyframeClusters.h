// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

/// What a keyframe moves with in an adjustment, as places. An anchor is its own.
struct Anchors {
  std::size_t main = 0;   ///< the nearest in time
  std::size_t other = 0;  ///< the one on the keyframe's other side
};

/// For every keyframe its anchors. Anchors follow each other by at most `interval_s`, unless the keyframes do not; the
/// first and the last of each run are anchors. 0 s: all are.
std::vector<Anchors> anchorsOf(const std::vector<RetiredKeyframe>& keyframes, double interval_s);

/// The same with the smallest interval from `interval_s` on, in steps of 0.1 s up to 10 s, that gives at most `most`
/// anchors; 0: any number.
std::vector<Anchors> fewAnchors(const std::vector<RetiredKeyframe>& keyframes, int most, double interval_s = 0);

}  // namespace lintel
