// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeProfile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lintel {
namespace {

cv::Mat show(double (*grey)(double, double)) {
  cv::Mat image(60, 80, CV_8U);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) image.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(grey(x, y));
  return image;
}

TEST(EdgeProfileTest, onARampAllGradientsAreItsSlope) {
  const cv::Mat image = show([](double x, double y) { return 20 + 2 * x + y; });  // exact in grey levels
  for (const double angle : {0.0, 0.6, 1.5, 3.0, -2.0})
    for (const double stride : {0.8, 1.0, 1.3}) {
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
      EdgeProfile profile{};
      gradientsAcross(image, {40.3, 30.7}, stride * n, stride, 3, profile);
      for (std::size_t i = 0; i < 2 * 3 + 3; ++i) EXPECT_NEAR(profile[i], 32 * (2 * n.x() + n.y()), 0.01);
    }
}

TEST(EdgeProfileTest, isStrongestOnTheEdge) {
  const cv::Mat image = show([](double x, double) { return 128 + 90 * std::tanh((x - 41) / 1.2); });
  EdgeProfile profile{};
  gradientsAcross(image, {40, 30}, {1, 0}, 1, 3, profile);  // places 36 to 44
  for (std::size_t i = 0; i < 2 * 3 + 3; ++i) EXPECT_LE(profile[i], profile[5]) << i;
  EXPECT_NEAR(profile[4], profile[6], 0.02 * profile[5]);
}

TEST(EdgeProfileTest, readsPixelsAroundTheImage) {
  const cv::Mat whole = show([](double x, double y) { return 20 + 2 * x + y; });
  const cv::Mat image = whole(cv::Rect(20, 20, 30, 20));
  EdgeProfile profile{};
  gradientsAcross(image, {0.4, 0.2}, {1, 0}, 1, 3, profile);
  for (std::size_t i = 0; i < 2 * 3 + 3; ++i) EXPECT_NEAR(profile[i], 64, 0.01);
}

}  // namespace
}  // namespace lintel
