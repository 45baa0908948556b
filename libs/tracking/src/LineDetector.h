// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "EdgeRefiner.h"
#include "ImageLine.h"
#include "ImagePyramid.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// Finds line segments in an image. Positions are as coarse as half resolution allows (about 1 px): EdgeRefiner lays
/// them on the edge.
class LineDetector {
 public:
  LineDetector(const LineCamera& camera, const LineTrackerParams& params);
  ~LineDetector();

  /// Segments of the current image, each with the brighter side along its normal, pieces of one edge that lie end to
  /// end joined; longer ones first.
  std::vector<ImageLine> detect(const ImagePyramid& pyramid);

  /// Those of them that are long enough in the used part of the image for a new line, as many as may be held: for
  /// trackers that do not lay lines on the edge.
  std::vector<ImageLine> detectLong(const ImagePyramid& pyramid);

  /// Standard deviation of a detection's ends across the line: half resolution.
  static constexpr double kSigma_px = 1.0;

 private:
  /// What OpenCV's detector finds, image pixels of full resolution (x0 y0 x1 y1).
  std::vector<cv::Vec4f> detectRaw(const ImagePyramid& pyramid);

  struct Engine;
  const LineCamera& camera_;
  LineTrackerParams params_;
  EdgeRefiner refiner_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace lintel
