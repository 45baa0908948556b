// SPDX-License-Identifier: BSD-3-Clause
#include "CornerDetector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace lintel {
namespace {

/// Squares on a grey wall: one is bright, the others have a tenth of its contrast.
class CornersOnAWall : public ::testing::Test {
 protected:
  CornersOnAWall() {
    for (int x = 60; x < image_.cols - 60; x += 140)
      for (int y = 60; y < image_.rows - 60; y += 120) {
        cv::rectangle(image_, cv::Rect(x, y, 40, 40), cv::Scalar(corners_.empty() ? 180 : 108), cv::FILLED);
        for (const int dx : {0, 39})
          for (const int dy : {0, 39}) corners_.emplace_back(static_cast<float>(x + dx), static_cast<float>(y + dy));
      }
  }

  /// With noise [grey levels].
  std::vector<cv::Point2f> detect(double noise) const {
    cv::Mat noisy(image_.size(), CV_32F), seen;
    cv::RNG(7).fill(noisy, cv::RNG::NORMAL, 0, noise);
    cv::add(image_, noisy, seen, cv::noArray(), CV_8U);
    ImagePyramid pyramid(PyramidParams(), params_.window_px);
    pyramid.push({seen.cols, seen.rows, {seen.begin<unsigned char>(), seen.end<unsigned char>()}});
    return CornerDetector({}, params_).detect(pyramid, {}, params_.max_points);
  }

  bool isCorner(const cv::Point2f& px) const {
    return std::any_of(corners_.begin(), corners_.end(),
                       [&](const cv::Point2f& corner) { return cv::norm(corner - px) < 6; });
  }

  PointTrackerParams params_;
  cv::Mat image_ = cv::Mat(480, 752, CV_8U, cv::Scalar(100));
  std::vector<cv::Point2f> corners_;
};

TEST_F(CornersOnAWall, AreFoundThoughOneIsMuchStronger) {
  const std::vector<cv::Point2f> found = detect(1);
  EXPECT_GE(std::count_if(found.begin(), found.end(), [&](const cv::Point2f& px) { return isCorner(px); }),
            static_cast<std::ptrdiff_t>(corners_.size()) * 3 / 4);
}

TEST_F(CornersOnAWall, NoiseIsHardlyEverOne) {
  for (const double noise : {1.0, 2.7, 4.0}) {
    const std::vector<cv::Point2f> found = detect(noise);
    const auto right = std::count_if(found.begin(), found.end(), [&](const cv::Point2f& px) { return isCorner(px); });
    EXPECT_GE(right, 40) << noise;
    EXPECT_LE(static_cast<std::ptrdiff_t>(found.size()) - right, 1) << "of 1400 blocks, with noise of " << noise;
  }
}

}  // namespace
}  // namespace lintel
