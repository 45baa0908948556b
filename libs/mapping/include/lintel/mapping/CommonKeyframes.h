// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lintel/geometry/Segment.h"

namespace lintel {

// Two landmarks in the keyframes that saw both. Views are ascending in their member `keyframe`.

/// Whether `holds(view of a, view of b)` for two views in one keyframe; looks no further then.
template <class View, class Id, class Predicate>
bool anyInCommonKeyframes(const std::vector<View>& a, const std::vector<View>& b, Id View::*keyframe,
                          const Predicate& holds) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if ((*i).*keyframe != (*j).*keyframe) {
      (*i).*keyframe < (*j).*keyframe ? ++i : ++j;
      continue;
    }
    for (auto k = j; k != b.end() && (*k).*keyframe == (*i).*keyframe; ++k)
      if (holds(*i, *k)) return true;
    ++i;
  }
  return false;
}

/// In how many pairs of views two lines run side by side in one image.
struct SideBySide {
  int apart = 0;     ///< farther from each other than the limit: two lines
  int together = 0;  ///< nearer
};

/// Of a line's view, raw pixels.
template <class View>
Segment2 segmentInImage(const View& view) {
  return {view.start_px.template cast<double>(), view.end_px.template cast<double>()};
}

template <class View, class Id>
SideBySide sideBySide(const std::vector<View>& a, const std::vector<View>& b, Id View::*keyframe, double apart_px) {
  SideBySide count;
  anyInCommonKeyframes(a, b, keyframe, [&](const View& v, const View& w) {
    const double px = separation(segmentInImage(v), segmentInImage(w));
    if (px >= 0) ++(px > apart_px ? count.apart : count.together);
    return false;
  });
  return count;
}

}  // namespace lintel
