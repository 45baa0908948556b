// SPDX-License-Identifier: BSD-3-Clause
#include "PatchAnchors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "TestImages.h"

namespace lintel {
namespace {

constexpr TrackId kId = 7;

/// A textured plane seen under changing views; the point under test is a fixed place on it.
class PatchAnchorsTest : public ::testing::Test {
 protected:
  /// The image when the plane appears turned and scaled about the middle.
  static cv::Mat show(double angle_rad, double scale, unsigned seed = 3, double gain = 1, double offset = 0) {
    const testing::Scene texture = testing::blobs(seed);
    const Eigen::Matrix2d to_plane = Eigen::Rotation2Dd(-angle_rad).toRotationMatrix() / scale;
    const Frame frame = testing::renderScene(
        testing::testRig(), [&](const Eigen::Vector2d& x) { return gain * texture(to_plane * x) + offset; }, 0);
    cv::Mat image(frame.image->height, frame.image->width, CV_8U);
    std::copy(frame.image->pixels.begin(), frame.image->pixels.end(), image.begin<unsigned char>());
    return image;
  }

  static cv::Point2f place(double angle_rad, double scale) {
    const Eigen::Vector2d on_plane(0.11, -0.07);
    const Eigen::Vector2d px = testing::testRig().camera.toPixel(scale * (Eigen::Rotation2Dd(angle_rad) * on_plane));
    return {static_cast<float>(px.x()), static_cast<float>(px.y())};
  }

  static double distance(const cv::Point2f& a, const cv::Point2f& b) { return std::hypot(a.x - b.x, a.y - b.y); }

  bool held(const cv::Mat& image, cv::Point2f& px, TrackId id = kId) {
    return anchors_.align(id, image, px) == AnchorVerdict::kHeld;
  }

  PatchAnchors anchors_{3};
};

TEST_F(PatchAnchorsTest, findsThePlaceAgainUnderAnotherView) {
  anchors_.add(kId, show(0, 1), place(0, 1));
  for (int k = 1; k <= 10; ++k) {  // to 17 degrees and 30 % nearer, as a track sees it
    const double angle = 0.03 * k, scale = 1 + 0.03 * k;
    cv::Point2f px = place(angle, scale) + cv::Point2f(0.5f, -0.4f);
    ASSERT_TRUE(held(show(angle, scale), px)) << k;
    EXPECT_LT(distance(px, place(angle, scale)), 0.1) << k;
  }
}

TEST_F(PatchAnchorsTest, brightnessAndContrastDoNotMatter) {
  anchors_.add(kId, show(0, 1), place(0, 1));
  cv::Point2f px = place(0.02, 1.02) + cv::Point2f(-0.6f, 0.3f);
  ASSERT_TRUE(held(show(0.02, 1.02, 3, 0.5, 20), px));
  EXPECT_LT(distance(px, place(0.02, 1.02)), 0.1);
}

TEST_F(PatchAnchorsTest, aSlipOfEveryFrameDoesNotAddUp) {
  cv::Point2f px = place(0, 1);
  anchors_.add(kId, show(0, 1), px);
  for (int k = 1; k <= 20; ++k) {
    px += cv::Point2f(0.24f, 0.15f);  // 5.7 px in the end
    ASSERT_TRUE(held(show(0, 1 + 0.006 * k), px)) << k;
  }
  EXPECT_LT(distance(px, place(0, 1.12)), 1.0);  // the view itself has moved by a few pixels
}

TEST_F(PatchAnchorsTest, aViewThatChangesTooMuchGetsANewPatch) {
  cv::Point2f px = place(0, 1);
  anchors_.add(kId, show(0, 1), px);
  for (int k = 1; k <= 25; ++k) {
    const double before = 1 + 0.02 * (k - 1), now = 1 + 0.02 * k;
    px += place(0, now) - place(0, before);
    ASSERT_TRUE(held(show(0, now), px)) << k;
  }
  EXPECT_LT(distance(px, place(0, 1.5)), 0.4);  // one patch ends where the next begins
}

TEST_F(PatchAnchorsTest, aPatchThatIsGoneEndsTheTrackButNotAtOnce) {
  anchors_.add(kId, show(0, 1), place(0, 1));
  const cv::Mat other = show(0, 1, 11);
  cv::Point2f px = place(0, 1);
  ASSERT_EQ(anchors_.align(kId, other, px), AnchorVerdict::kUnsure) << "a blurred frame is survived";
  EXPECT_EQ(px, place(0, 1)) << "and the place left as the flow says";
  int survived = 1;
  while (survived < 20 && anchors_.align(kId, other, px) != AnchorVerdict::kLost) ++survived;
  EXPECT_LT(survived, 6);
  cv::Point2f back = place(0, 1);
  EXPECT_TRUE(held(show(0, 1), back)) << "seen again, it counts from new";
  EXPECT_EQ(anchors_.align(kId, other, px), AnchorVerdict::kUnsure);
}

TEST_F(PatchAnchorsTest, aTrackEndsAfterMoreFailuresThanAreAllowed) {
  const cv::Mat image = show(0, 1), other = show(0, 1, 11);
  for (const int failures : {1, 3}) {
    PatchAnchors anchors(failures);
    anchors.add(kId, image, place(0, 1));
    cv::Point2f px = place(0, 1);
    for (int i = 0; i < failures; ++i) ASSERT_EQ(anchors.align(kId, other, px), AnchorVerdict::kUnsure) << failures;
    ASSERT_EQ(anchors.align(kId, image, px), AnchorVerdict::kHeld) << "counted anew";
    for (int i = 0; i < failures; ++i) ASSERT_EQ(anchors.align(kId, other, px), AnchorVerdict::kUnsure) << failures;
    EXPECT_EQ(anchors.align(kId, other, px), AnchorVerdict::kLost) << failures;
  }
}

TEST_F(PatchAnchorsTest, forgetsWhatIsNotTracked) {
  anchors_.add(kId, show(0, 1), place(0, 1));
  EXPECT_TRUE(anchors_.has(kId));
  anchors_.keepOnly({});
  EXPECT_FALSE(anchors_.has(kId));
  cv::Point2f px = place(0, 1) + cv::Point2f(0.7f, 0);
  const cv::Point2f flow = px;
  EXPECT_EQ(anchors_.align(kId, show(0, 1), px), AnchorVerdict::kUnsure);
  EXPECT_EQ(px, flow);
}

TEST_F(PatchAnchorsTest, withoutTextureOrRoomTheFlowDecides) {
  const cv::Mat grey(320, 480, CV_8U, cv::Scalar(90));
  cv::Point2f px(240, 160);
  anchors_.add(1, grey, px);
  EXPECT_EQ(anchors_.align(1, grey, px), AnchorVerdict::kUnsure);
  EXPECT_EQ(px, cv::Point2f(240, 160));
  cv::Point2f corner(2, 2);
  anchors_.add(2, show(0, 1), corner);
  EXPECT_EQ(anchors_.align(2, show(0, 1), corner), AnchorVerdict::kUnsure);
  EXPECT_EQ(corner, cv::Point2f(2, 2));
}

}  // namespace
}  // namespace lintel
