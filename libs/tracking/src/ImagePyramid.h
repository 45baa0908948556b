// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "lintel/sensing/Frame.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// The pyramids (images and derivatives) of the current frame and the one before, built once for points and lines.
class ImagePyramid {
 public:
  /// `window_px`: the largest KLT window that will be used on it.
  ImagePyramid(const PyramidParams& params, int window_px);

  /// Makes the current pyramid the previous one and builds that of `image`.
  void push(const GrayImage& image);

  bool hasPrevious() const { return frames_ > 1; }
  /// For cv::calcOpticalFlowPyrLK: image, derivative, image, derivative, ...
  const std::vector<cv::Mat>& current() const { return pyramids_[frames_ % 2]; }
  const std::vector<cv::Mat>& previous() const { return pyramids_[(frames_ + 1) % 2]; }

  const cv::Mat& image(int level = 0) const { return current()[2 * static_cast<std::size_t>(level)]; }
  /// Scharr derivatives (int16 dx, dy) of a level, 32 times the grey levels per pixel.
  const cv::Mat& derivative(int level = 0) const { return current()[2 * static_cast<std::size_t>(level) + 1]; }
  int windowPx() const { return window_px_; }
  int levels() const { return static_cast<int>(current().size() / 2); }

 private:
  PyramidParams params_;
  int window_px_;
  cv::Ptr<cv::CLAHE> clahe_;
  std::vector<cv::Mat> pyramids_[2];
  std::uint64_t frames_ = 0;
};

}  // namespace lintel
