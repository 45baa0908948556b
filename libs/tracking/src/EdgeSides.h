// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "ImageLine.h"

namespace lintel {

/// Mean grey levels beside a segment, on its darker and its brighter side.
struct EdgeSides {
  float dark = 0, bright = 0;
  float step() const { return bright - dark; }
  float mean() const { return 0.5f * (dark + bright); }
};

/// What lies beside an edge, a few pixels off: neighbouring edges of the same direction and sign differ in it. Empty
/// where too little of the segment is in the image (8 bit grey).
std::optional<EdgeSides> sidesOf(const LineCamera& camera, const cv::Mat& image, const ImageLine& line);

/// Whether an edge may be the one that had these grey levels beside it. Blur brings both sides nearer to each other,
/// and their mean stays; the next step of a staircase has another mean.
bool maybeSame(const EdgeSides& now, const EdgeSides& before);

}  // namespace lintel
