// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>

#include "lintel/core/Rig.h"

namespace lintel {

/// Where the image is used: where the rig's mask is not black, if it has one, and where nothing was found that moves
/// with the camera (VehicleParts). A hood, arms or the rim of a lens would be tracked as a part of the place. Copies
/// share what they cover.
class ImageMask {
 public:
  ImageMask() = default;
  /// A patch around a pixel that is used does not reach into the black by more than a step of optical flow.
  explicit ImageMask(const Rig& rig);

  /// Covers what is not 0 in `area`, of the image's size, as well.
  void cover(const cv::Mat& area);

  /// Whether a pixel is not used; false outside the image.
  bool covers(const Eigen::Vector2d& px) const {
    if (covered_->empty()) return false;
    const int x = static_cast<int>(px.x() + 0.5), y = static_cast<int>(px.y() + 0.5);
    return x >= 0 && y >= 0 && x < covered_->cols && y < covered_->rows && covered_->at<unsigned char>(y, x) != 0;
  }

  /// Sets the pixels of `image` that are not used to 0; `scale`: full resolution pixels of one of its pixels.
  void blacken(cv::Mat& image, int scale) const;

 private:
  std::shared_ptr<cv::Mat> covered_ = std::make_shared<cv::Mat>();  ///< not 0 where not used; empty: all is used
};

}  // namespace lintel
