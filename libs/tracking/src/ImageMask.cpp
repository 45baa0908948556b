// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMask.h"

#include <opencv2/imgproc.hpp>

namespace lintel {
namespace {

constexpr int kMargin_px = 6;  ///< half the patch of a point

}  // namespace

ImageMask::ImageMask(const Rig& rig) {
  if (!rig.mask) return;
  const cv::Mat mask(rig.mask->height, rig.mask->width, CV_8U, const_cast<std::uint8_t*>(rig.mask->pixels.data()));
  cover(mask == 0);
}

void ImageMask::cover(const cv::Mat& area) {
  const int side = 2 * kMargin_px + 1;
  cv::Mat wider;
  cv::dilate(area, wider, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  if (covered_->empty())
    *covered_ = wider;
  else
    *covered_ |= wider;
}

void ImageMask::blacken(cv::Mat& image, int scale) const {
  if (covered_->empty()) return;
  cv::Mat covered;
  cv::resize(*covered_, covered, image.size(), 1.0 / scale, 1.0 / scale, cv::INTER_NEAREST);
  image.setTo(0, covered);
}

}  // namespace lintel
