// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "ImageLine.h"
#include "ImagePyramid.h"

namespace lintel {

/// A segment laid on the image's edge.
struct RefinedLine {
  ImageLine line;
  double sigma_px = 1;  ///< standard deviation of an end's distance from the edge
  double support = 0;   ///< share of samples along the line that see the edge
};

/// Lays segments on the maximum of the image gradient: the position comes from this frame's edge only, so that small
/// errors of optical flow never add up. A line's normal points to the brighter side; an edge of opposite contrast
/// nearby (the other side of a board) is a different line and is not seen.
class EdgeRefiner {
 public:
  explicit EdgeRefiner(const LineCamera& camera) : camera_(camera) {}

  /// Samples profiles of the current image's gradient across `line` up to `search_px` to both sides, fits the line
  /// robustly in undistorted coordinates, trims ends that have no edge and grows by up to `grow_px` where the edge goes
  /// on. An edge that full resolution does not show (motion blur) is looked for at half. Empty when less than half of
  /// the line lies on an edge.
  std::optional<RefinedLine> refine(const ImagePyramid& pyramid, const ImageLine& line, double search_px,
                                    double grow_px) const;

  /// Turns `line` so that its normal points to the brighter side; empty when the contrast is not of one sign.
  std::optional<ImageLine> orient(const cv::Mat& image, const ImageLine& line) const;

 private:
  std::optional<RefinedLine> refineAtLevel(const ImagePyramid& pyramid, int level, const ImageLine& line,
                                           double search_px, double grow_px) const;

  const LineCamera& camera_;
};

}  // namespace lintel
