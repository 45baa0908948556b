// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/ParamRange.h"
#include "lintel/tracking/SegmentDetector.h"

namespace lintel {

/// The search for lines in the keyframes' images, after the refinement.
struct DensifyParams {
  bool enabled = true;
  SegmentParams segments;
  double interval_s = 0.2;         ///< between keyframes whose images are searched, at least
  int views = 30;                  ///< keyframes in which a candidate is looked for, of those that see the same points
  int partners = 12;               ///< of these: with whose segments a segment is paired
  double tolerance_px = 2;         ///< between an edge and a projected candidate
  double least_cover = 0.5;        ///< of a candidate's length in an image, on edges: less does not support it
  int min_keyframes = 4;           ///< that support a line
  double min_parallax_rad = 0.02;  ///< between the planes of views, of three at least
  double least_share = 0.3;        ///< of the images that should see it, to be covered on the average
  double max_error_ratio = 2;      ///< of a line's mean error to what 95 % of the tracked lines keep
  double max_chance = 1e-4;        ///< that edges which happen to be there support a line as well

  template <class F>
  void fields(F&& field) {
    field("enabled", enabled);
    field("segments", segments);
    field("interval_s", interval_s, Range{0, 1000});
    field("views", views, Range{4, 1000});
    field("partners", partners, Range{1, 1000});
    field("tolerance_px", tolerance_px, Range{0.5, 20});
    field("least_cover", least_cover, Range{0.1, 1});
    field("min_keyframes", min_keyframes, Range{3, 1000});
    field("min_parallax_rad", min_parallax_rad, Range{0, 1});
    field("least_share", least_share, Range{0, 1});
    field("max_error_ratio", max_error_ratio, Range{0.1, 100});
    field("max_chance", max_chance, Range{1e-30, 1});
  }
};

}  // namespace lintel
