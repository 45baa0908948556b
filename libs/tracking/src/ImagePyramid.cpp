// SPDX-License-Identifier: BSD-3-Clause
#include "ImagePyramid.h"

#include <opencv2/video/tracking.hpp>

#include "PatchFlow.h"

namespace lintel {

ImagePyramid::ImagePyramid(const PyramidParams& params, int window_px) : params_(params), window_px_(window_px) {
  if (params_.equalise) clahe_ = cv::createCLAHE(params_.clip_limit, cv::Size(8, 8));
}

void ImagePyramid::push(const GrayImage& image) {
  ++frames_;
  // OpenCV has no const Mat over foreign memory; the pixels are only read.
  cv::Mat input(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  if (clahe_) {
    cv::Mat equalised;
    clahe_->apply(input, equalised);
    input = equalised;
  }
  const int border = patchBorder(window_px_);
  cv::buildOpticalFlowPyramid(input, pyramids_[frames_ % 2], cv::Size(border, border), params_.levels - 1, false,
                              cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
}

}  // namespace lintel
