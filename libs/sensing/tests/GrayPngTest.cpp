// SPDX-License-Identifier: BSD-3-Clause
#include "../src/GrayPng.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

namespace lintel {
namespace {

/// Smooth, with edges and noise: libpng's encoder chooses every filter for some row.
cv::Mat somePicture(int width, int height) {
  cv::Mat picture(height, width, CV_8U);
  std::uint32_t noise = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      noise = noise * 1664525u + 1013904223u;
      picture.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(
          (x * y / 50 + (x / 9 % 2) * 70 + (y % 40 < 20 ? 3 * y : 0) + (y > 60 ? noise >> 29 : 0)) & 255);
    }
  return picture;
}

std::vector<std::uint8_t> encoded(const cv::Mat& picture, int strategy = 3) {
  std::vector<std::uint8_t> file;
  cv::imencode(".png", picture, file, {cv::IMWRITE_PNG_COMPRESSION, 6, cv::IMWRITE_PNG_STRATEGY, strategy});
  return file;
}

std::vector<std::uint8_t> pixelsOf(const cv::Mat& picture) { return {picture.datastart, picture.dataend}; }

TEST(GrayPng, GivesThePixelsThatWereWritten) {
  for (const int width : {1, 2, 8, 15, 16, 17, 23, 24, 30, 31, 33, 47, 752})
    for (const int height : {1, 7, 8, 9, 31, 121})
      for (const int strategy : {0, 1, 3}) {  // which filters the encoder uses depends on it
        const cv::Mat picture = somePicture(width, height);
        const auto image = decodeGrayPng(encoded(picture, strategy));
        ASSERT_TRUE(image) << width << "x" << height;
        EXPECT_EQ(image->width, width);
        EXPECT_EQ(image->height, height);
        ASSERT_EQ(image->pixels, pixelsOf(picture)) << width << "x" << height << " strategy " << strategy;
      }
}

TEST(GrayPng, LeavesOtherKindsToOthers) {
  const cv::Mat gray = somePicture(20, 20);
  cv::Mat colour(20, 20, CV_8UC3, cv::Scalar(1, 2, 3)), deep(20, 20, CV_16U, cv::Scalar(300));
  EXPECT_FALSE(decodeGrayPng(encoded(colour)));
  EXPECT_FALSE(decodeGrayPng(encoded(deep)));
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", gray, jpeg);
  EXPECT_FALSE(decodeGrayPng(jpeg));
  EXPECT_FALSE(decodeGrayPng({}));
  EXPECT_FALSE(isDamagedPng(encoded(colour)));
  EXPECT_FALSE(isDamagedPng(jpeg));
}

TEST(GrayPng, ADamagedFileIsNoImage) {
  const std::vector<std::uint8_t> whole = encoded(somePicture(64, 48));
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_FALSE(decodeGrayPng({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
  for (std::size_t at = 8; at + 12 < whole.size(); at += 5) {
    std::vector<std::uint8_t> damaged = whole;
    damaged[at] ^= 0x41;
    EXPECT_FALSE(decodeGrayPng(damaged)) << at;
    EXPECT_TRUE(isDamagedPng(damaged)) << at;
  }
}

}  // namespace
}  // namespace lintel
