// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "ImageMask.h"
#include "ImagePyramid.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// Finds new corners to track where there are none yet, spread evenly over the image.
class CornerDetector {
 public:
  CornerDetector(const ImageMask& mask, const PointTrackerParams& params) : mask_(mask), params_(params) {}

  /// Up to `wanted` corners of the current image, at least min_distance_px from `taken` and from each other. Cells of
  /// the image with fewer points come first, then stronger corners.
  std::vector<cv::Point2f> detect(const ImagePyramid& pyramid, const std::vector<cv::Point2f>& taken, int wanted) const;

 private:
  ImageMask mask_;
  PointTrackerParams params_;
};

}  // namespace lintel
