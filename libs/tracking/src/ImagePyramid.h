// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// The pyramids of the current frame and the one before, built once for points and lines.
class ImagePyramid {
 public:
  /// `window_px`: the largest window of optical flow that will be used on it.
  ImagePyramid(const PyramidParams& params, int window_px);

  /// Makes the current pyramid the previous one and builds that of `image`.
  void push(const GrayImage& image);

  bool hasPrevious() const { return frames_ > 1; }
  /// Levels from full resolution on, with readable pixels around as followPatches() needs them.
  const std::vector<cv::Mat>& current() const { return pyramids_[frames_ % 2]; }
  const std::vector<cv::Mat>& previous() const { return pyramids_[(frames_ + 1) % 2]; }

  const cv::Mat& image(int level = 0) const { return current()[static_cast<std::size_t>(level)]; }
  int windowPx() const { return window_px_; }
  int levels() const { return static_cast<int>(current().size()); }

 private:
  PyramidParams params_;
  int window_px_;
  cv::Ptr<cv::CLAHE> clahe_;
  std::vector<cv::Mat> pyramids_[2];
  std::uint64_t frames_ = 0;
};

}  // namespace lintel
