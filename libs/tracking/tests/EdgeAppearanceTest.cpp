// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeAppearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "TestImages.h"

namespace lintel {
namespace {

cv::Mat show(double (*grey)(double, double)) {
  cv::Mat image(60, 80, CV_8U);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) image.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(grey(x, y));
  return image;
}

TEST(GradientsAcross, onARampAllGradientsAreItsSlope) {
  const cv::Mat image = show([](double x, double y) { return 20 + 2 * x + y; });  // exact in grey levels
  for (const double angle : {0.0, 0.6, 1.5, 3.0, -2.0})
    for (const double stride : {0.8, 1.0, 1.3}) {
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
      GradientProfile profile{};
      gradientsAcross(image, {40.3, 30.7}, stride * n, stride, 3, profile);
      for (std::size_t i = 0; i < 2 * 3 + 3; ++i) EXPECT_NEAR(profile[i], 32 * (2 * n.x() + n.y()), 0.01);
    }
}

TEST(GradientsAcross, isStrongestOnTheEdge) {
  const cv::Mat image = show([](double x, double) { return 128 + 90 * std::tanh((x - 41) / 1.2); });
  GradientProfile profile{};
  gradientsAcross(image, {40, 30}, {1, 0}, 1, 3, profile);  // places 36 to 44
  for (std::size_t i = 0; i < 2 * 3 + 3; ++i) EXPECT_LE(profile[i], profile[5]) << i;
  EXPECT_NEAR(profile[4], profile[6], 0.02 * profile[5]);
}

TEST(GradientsAcross, readsPixelsAroundTheImage) {
  const cv::Mat whole = show([](double x, double y) { return 20 + 2 * x + y; });
  const cv::Mat image = whole(cv::Rect(20, 20, 30, 20));
  GradientProfile profile{};
  gradientsAcross(image, {0.4, 0.2}, {1, 0}, 1, 3, profile);
  for (std::size_t i = 0; i < 2 * 3 + 3; ++i) EXPECT_NEAR(profile[i], 64, 0.01);
}

TEST(SideLevels, AreTheGreyLevelsBesideTheEdge) {
  const Camera pinhole = testing::testRig().camera;
  const LineCamera camera(pinhole);
  cv::Mat image(pinhole.height, pinhole.width, CV_8U, cv::Scalar(150));
  image.rowRange(0, 100) = 70;
  const double y = 99.5;  // between the two
  const auto sides = sideLevels(camera, image, {camera.fromImage({60, y}), camera.fromImage({200, y})});
  ASSERT_TRUE(sides);
  EXPECT_EQ(sides->dark, 70);
  EXPECT_EQ(sides->bright, 150);
  const double right = pinhole.width - 1.0;
  EXPECT_FALSE(sideLevels(camera, image, {camera.fromImage({right - 20, y}), camera.fromImage({right + 80, y})}))
      << "hardly any of it in the image";
}

TEST(SideLevels, TellTheNextEdgeOfAStaircase) {
  EXPECT_TRUE(maybeSameEdge({90, 130}, {70, 150})) << "blurred";
  EXPECT_TRUE(maybeSameEdge({80, 170}, {70, 150})) << "a little more light";
  EXPECT_FALSE(maybeSameEdge({150, 210}, {70, 150})) << "the next edge";
}

}  // namespace
}  // namespace lintel
