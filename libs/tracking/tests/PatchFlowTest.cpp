// SPDX-License-Identifier: BSD-3-Clause
#include "PatchFlow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace lintel {
namespace {

constexpr int kWidth = 240, kHeight = 160;

/// Grey level of a smooth texture at a real-valued place.
double texture(double x, double y) {
  return 128 + 25 * std::sin(0.37 * x + 0.11 * y) + 25 * std::cos(0.33 * y - 0.09 * x) +
         30 * std::sin(0.071 * x + 0.03 * y) + 30 * std::cos(0.067 * y - 0.021 * x);
}

/// The texture moved by `shift`: what was at p is at p + shift.
cv::Mat show(const cv::Point2d& shift, double (*scene)(double, double) = texture) {
  cv::Mat image(kHeight, kWidth, CV_8U);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      image.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(scene(x - shift.x, y - shift.y));
  return image;
}

std::vector<cv::Mat> pyramid(const cv::Mat& image, int levels, int window_px) {
  std::vector<cv::Mat> result;
  const int border = patchBorder(window_px);
  cv::buildOpticalFlowPyramid(image, result, cv::Size(border, border), levels - 1, false, cv::BORDER_REFLECT_101,
                              cv::BORDER_CONSTANT, false);
  return result;
}

std::vector<cv::Point2f> places() {
  std::vector<cv::Point2f> px;
  for (float y = 30.25f; y < kHeight - 30; y += 19)
    for (float x = 30.6f; x < kWidth - 30; x += 23) px.emplace_back(x, y);
  return px;
}

/// Follows a single patch; `place` is the guess, then what was found.
bool followsOne(const cv::Mat& from, const cv::Mat& to, const cv::Point2f& px, const PatchFlowParams& params,
                cv::Point2f& place) {
  std::vector<cv::Point2f> moved{place};
  const bool found = followPatches(pyramid(from, params.levels, params.window_px),
                                   pyramid(to, params.levels, params.window_px), {px}, params, moved)[0] != 0;
  place = moved[0];
  return found;
}

/// Windows that fill whole vectors, and that do not.
class PatchFlowOfSize : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Windows, PatchFlowOfSize, ::testing::Values(5, 8, 9, 13, 16, 17, 24, 51));

TEST_P(PatchFlowOfSize, findsAShiftBetweenPixels) {
  const cv::Point2d shift(1.37, -0.82);
  PatchFlowParams params;
  params.window_px = GetParam();
  const std::vector<cv::Point2f> px = places();
  std::vector<cv::Point2f> moved = px;
  const auto found =
      followPatches(pyramid(show({0, 0}), 1, GetParam()), pyramid(show(shift), 1, GetParam()), px, params, moved);
  int good = 0;
  for (std::size_t i = 0; i < px.size(); ++i)
    good += found[i] && cv::norm(cv::Point2d(moved[i]) - cv::Point2d(px[i]) - shift) < 0.05;
  EXPECT_GE(10 * good, static_cast<int>(px.size()) * (GetParam() < 8 ? 5 : 9));  // few pixels say little
}

/// From the size of patches on lines on: fewer pixels say little where brightness and contrast are free.
class LargerPatchFlow : public PatchFlowOfSize {};
INSTANTIATE_TEST_SUITE_P(Windows, LargerPatchFlow, ::testing::Values(8, 13, 16, 17, 24, 51));

TEST_P(LargerPatchFlow, agreesWithOpenCvWhereBrightnessStays) {
  const cv::Mat to = show({2.3, 1.9});
  PatchFlowParams params{GetParam(), 2, 20, 0.01, 0.1};
  const std::vector<cv::Point2f> px = places();
  std::vector<cv::Point2f> moved = px, expected = px;
  const auto found = followPatches(pyramid(show({0, 0}), 2, GetParam()), pyramid(to, 2, GetParam()), px, params, moved);
  std::vector<unsigned char> known;
  cv::calcOpticalFlowPyrLK(show({0, 0}), to, px, expected, known, cv::noArray(), cv::Size(GetParam(), GetParam()), 1,
                           {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.01}, cv::OPTFLOW_USE_INITIAL_FLOW,
                           1e-4);
  int alike = 0;
  for (std::size_t i = 0; i < px.size(); ++i)
    alike += found[i] == known[i] && (!found[i] || cv::norm(moved[i] - expected[i]) < (GetParam() < 13 ? 0.1 : 0.02));
  EXPECT_GE(alike, static_cast<int>(px.size()) * 19 / 20);
}

TEST_P(LargerPatchFlow, brightnessAndContrastMoveNothing) {
  const cv::Point2d shift(1.37, -0.82);
  PatchFlowParams params{GetParam(), 2, 20, 0.01, 0.1};
  for (const auto& [contrast, brightness] : {std::pair{0.4, 0.0}, {0.4, 150.0}, {0.25, 90.0}, {2.0, -128.0}}) {
    const auto wide = [](double x, double y) { return 128 + 0.5 * (texture(x, y) - 128); };  // stays within 0 and 255
    cv::Mat to = show(shift, wide);
    to.convertTo(to, CV_8U, contrast, brightness);
    const std::vector<cv::Point2f> px = places();
    std::vector<cv::Point2f> moved = px;
    const auto found =
        followPatches(pyramid(show({0, 0}, wide), 2, GetParam()), pyramid(to, 2, GetParam()), px, params, moved);
    int good = 0;
    for (std::size_t i = 0; i < px.size(); ++i)
      good += found[i] && cv::norm(cv::Point2d(moved[i]) - cv::Point2d(px[i]) - shift) < 0.15;
    EXPECT_GE(10 * good, static_cast<int>(px.size()) * (GetParam() < 13 ? 8 : 9)) << contrast << " " << brightness;
  }
}

TEST(PatchFlowTest, aBlackImageShowsNothing) {
  const cv::Point2f px(120, 80);
  cv::Point2f place = px;
  const cv::Mat black(kHeight, kWidth, CV_8U, cv::Scalar(3));
  EXPECT_FALSE(followsOne(show({0, 0}), black, px, PatchFlowParams{13, 2, 20, 0.01, 0.1}, place));
}

TEST(PatchFlowTest, comesFromAfarOverSeveralLevels) {
  const cv::Point2f px(120, 80);
  cv::Point2f near = px, far = px;
  PatchFlowParams params{13, 4, 20, 0.01, 0.1};
  EXPECT_TRUE(followsOne(show({0, 0}), show({14, -9}), px, params, far));
  EXPECT_LT(cv::norm(far - px - cv::Point2f(14, -9)), 0.05);
  params.levels = 1;
  followsOne(show({0, 0}), show({14, -9}), px, params, near);
  EXPECT_GT(cv::norm(near - px - cv::Point2f(14, -9)), 1);
}

TEST(PatchFlowTest, startsAtTheGuess) {
  const cv::Point2f px(120, 80);
  cv::Point2f place = px + cv::Point2f(39, 20);
  EXPECT_TRUE(followsOne(show({0, 0}), show({40, 20.5}), px, PatchFlowParams{}, place));
  EXPECT_LT(cv::norm(place - px - cv::Point2f(40, 20.5)), 0.05);
}

TEST(PatchFlowTest, onAnEdgeMovesAcrossIt) {
  const auto edge = [](double x, double) { return 128 + 90 * std::tanh((x - 100) / 1.5); };
  const cv::Point2f px(100, 80);
  cv::Point2f place = px;
  PatchFlowParams params{9, 1, 20, 0.01, 0};
  const cv::Mat from = show({0, 0}, edge), to = show({0.7, 0}, edge);
  EXPECT_FALSE(followsOne(from, to, px, PatchFlowParams{9, 1, 20, 0.01, 0.1}, place))
      << "too little texture along the edge";
  cv::Mat marked_from = from.clone(), marked_to = to.clone();
  marked_from.at<unsigned char>(82, 101) += 3;  // next to nothing, as real edges have
  marked_to.at<unsigned char>(82, 101) += 3;
  place = px;
  EXPECT_TRUE(followsOne(marked_from, marked_to, px, params, place));
  EXPECT_NEAR(place.x - px.x, 0.7, 0.05);
}

TEST(PatchFlowTest, plainGreyIsLost) {
  const cv::Mat plain(kHeight, kWidth, CV_8U, cv::Scalar(90));
  cv::Point2f place(120, 80);
  EXPECT_FALSE(followsOne(plain, plain, place, PatchFlowParams{}, place));
}

TEST(PatchFlowTest, outsideTheImageIsLost) {
  const cv::Mat image = show({0, 0});
  for (const cv::Point2f px :
       {cv::Point2f(-20, 80), cv::Point2f(120, -20), cv::Point2f(kWidth + 20, 80), cv::Point2f(120, kHeight + 20)}) {
    cv::Point2f from_inside = px, to_inside(120, 80);
    EXPECT_FALSE(followsOne(image, image, {120, 80}, PatchFlowParams{}, from_inside)) << px;
    EXPECT_FALSE(followsOne(image, image, px, PatchFlowParams{}, to_inside)) << px;
  }
}

TEST(PatchFlowTest, anUnknownGuessIsLost) {
  const cv::Mat image = show({0, 0});
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (cv::Point2f place : {cv::Point2f(nan, 80), cv::Point2f(120, nan), cv::Point2f(inf, 80), cv::Point2f(120, -inf),
                            cv::Point2f(1e30f, 0)})
    EXPECT_FALSE(followsOne(image, image, {120, 80}, PatchFlowParams{}, place));
}

TEST(PatchFlowTest, readsNoFurtherThanItsBorder) {
  // Patches at every place on the rim, in images that end where patchBorder() says: memory checkers would see more.
  for (const int window_px : {5, 8, 13, 16}) {
    const int border = patchBorder(window_px);
    const auto bordered = [&](const cv::Point2d& shift) {
      cv::Mat whole;
      cv::copyMakeBorder(show(shift), whole, border, border, border, border, cv::BORDER_REFLECT_101);
      return std::vector<cv::Mat>{whole(cv::Rect(border, border, kWidth, kHeight))};
    };
    std::vector<cv::Point2f> px;
    for (float x = -0.5f; x <= kWidth; x += 7.1f) px.emplace_back(x, -0.4f), px.emplace_back(x, kHeight - 0.6f);
    for (float y = -0.5f; y <= kHeight; y += 7.1f) px.emplace_back(-0.4f, y), px.emplace_back(kWidth - 0.6f, y);
    std::vector<cv::Point2f> moved = px;
    const auto found =
        followPatches(bordered({0, 0}), bordered({0, 0}), px, PatchFlowParams{window_px, 1, 5, 0.01, 0.1}, moved);
    if (window_px >= 8) {  // of smaller ones the image has too few pixels to say something
      EXPECT_GT(2 * std::count(found.begin(), found.end(), 1), static_cast<std::ptrdiff_t>(px.size()));
    }
    for (std::size_t i = 0; i < px.size(); ++i) {
      if (found[i]) {
        EXPECT_LT(cv::norm(moved[i] - px[i]), 0.05) << px[i];
      }
    }
  }
}

TEST(PatchFlowTest, blackAndWhiteDoNotOverflow) {
  const auto stripes = [](double x, double y) {
    return (std::fmod(x + 400, 16) < 8) != (std::fmod(y + 400, 12) < 6) ? 255.0 : 0.0;
  };
  const cv::Point2f px(120, 80);
  for (const int window_px : {13, 51}) {
    cv::Point2f place = px;
    EXPECT_TRUE(followsOne(show({0, 0}, stripes), show({1, 0}, stripes), px,
                           PatchFlowParams{window_px, 1, 20, 0.01, 0.1}, place));
    EXPECT_LT(cv::norm(place - px - cv::Point2f(1, 0)), 0.05);
  }
}

}  // namespace
}  // namespace lintel
