// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "SegmentView.h"
#include "lintel/geometry/Segment.h"

namespace lintel {

/// What an image says of a segment in space.
struct LineSupport {
  bool visible = false;         ///< enough of it is within the image
  double cover = 0;             ///< share of the visible part that lies on edges of its direction and sides
  std::vector<std::size_t> by;  ///< these edges
};

/// A segment as a view sees it: the part within the image.
struct SeenSegment {
  Eigen::Vector3d normal_c = Eigen::Vector3d::Zero();  ///< of the plane through it, unit, start x end
  Eigen::Vector3d start_c = Eigen::Vector3d::Zero();   ///< unit ray of its beginning
  double length_rad = 0;                               ///< 0: not seen
};
SeenSegment seenSegment(const SegmentView& view, const Segment3& segment_w);

/// The grey levels of an edge's sides.
struct EdgeLook {
  explicit EdgeLook(const EdgeSegment& edge)
      : mean(0.5f * (edge.dark + edge.bright)), contrast(edge.bright - edge.dark) {}
  bool maybeSame(const EdgeLook& other) const;

  float mean, contrast;
};

/// How far edges of `view` cover `seen`; edges farther than `tolerance_px` at either end, of another direction, with
/// the brighter side on the other side, or taken do not count.
LineSupport supportOf(const SegmentView& view, const SeenSegment& seen, double tolerance_px, bool taken_too,
                      const EdgeLook* look);

/// The share of `seen` that edges of the image would cover by chance: what they cover of it elsewhere nearby.
double chanceOf(const SegmentView& view, const SeenSegment& seen, double tolerance_px, const EdgeLook& look);

/// The chance that `k` or more of `n` happen where each has the chance `p`.
double binomialTail(int k, int n, double p);

}  // namespace lintel
