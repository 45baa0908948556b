// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMask.h"

#include <gtest/gtest.h>

#include "TestImages.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/tracking/FrontEnd.h"

namespace lintel {
namespace {

using testing::kStep_ns;

/// Black over `box` of the test rig's image.
std::shared_ptr<const GrayImage> maskWith(const cv::Rect& box) {
  const Camera camera = testing::testRig().camera;
  auto mask = std::make_shared<GrayImage>();
  mask->width = camera.width;
  mask->height = camera.height;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) mask->pixels.push_back(box.contains({x, y}) ? 0 : 255);
  return mask;
}

/// Textured everywhere, with a strip across the image.
double scene(const Eigen::Vector2d& x) {
  static const auto strip = testing::strips({{{-0.7, -0.02}, {0.7, 0.06}, 0.03}}, {}, 0, 180);
  const double grey = strip(x);
  return grey > 0 ? grey : 0.4 * testing::blobs(3)(x);
}

std::vector<FrameTracks> track(const Rig& rig) {
  FrontEndParams params;
  params.lines.sightings_before_use = params.lines.detect_every_n = 1;
  FrontEnd front_end(rig, params);
  const Eigen::Vector3d rate_c(0.25, -0.35, 0.5);
  std::vector<FrameTracks> result;
  for (int i = 0; i < 6; ++i) {
    const Frame frame = testing::renderScene(rig, scene, i * kStep_ns, expRotation(-0.05 * i * rate_c));
    result.push_back(
        front_end.process(frame, testing::constantRate((i - 1) * kStep_ns, i * kStep_ns, rig.T_b_c.q * rate_c)));
  }
  return result;
}

TEST(ImageMask, NothingIsTrackedWhereItIsBlack) {
  const cv::Rect2d box(240, 80, 240, 160);
  Rig rig = testing::testRig();
  const auto all = track(rig);
  rig.mask = maskWith(box);
  const auto masked = track(rig);
  const auto isIn = [&](const Eigen::Vector2d& px) { return box.contains({px.x(), px.y()}); };
  const auto pointsIn = [&](const FrameTracks& frame) {
    return std::count_if(frame.points.begin(), frame.points.end(), [&](const auto& p) { return isIn(p.px); });
  };
  const auto endsIn = [&](const FrameTracks& frame) {
    return std::count_if(frame.lines.begin(), frame.lines.end(),
                         [&](const auto& l) { return isIn(l.start_px) || isIn(l.end_px); });
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_GT(pointsIn(all[i]), 10) << i;
    EXPECT_GT(endsIn(all[i]), 0) << i;
    EXPECT_EQ(pointsIn(masked[i]), 0) << i;
    EXPECT_EQ(endsIn(masked[i]), 0) << i;
    EXPECT_GT(masked[i].points.size(), 40U) << i;
    EXPECT_GE(masked[i].lines.size(), 2U) << i;  // the strip, as far as it is seen
  }
}

TEST(ImageMask, WhiteEverywhereChangesNothing) {
  Rig rig = testing::testRig();
  const auto without = track(rig);
  rig.mask = maskWith({});
  const auto with = track(rig);
  ASSERT_EQ(without.back().points.size(), with.back().points.size());
  for (std::size_t i = 0; i < with.back().points.size(); ++i)
    EXPECT_EQ(without.back().points[i].px, with.back().points[i].px);
  ASSERT_EQ(without.back().lines.size(), with.back().lines.size());
}

TEST(ImageMask, AnotherSizeThanTheCamerasIsRefused) {
  Rig rig = testing::testRig();
  rig.mask = std::make_shared<GrayImage>(GrayImage{10, 10, std::vector<std::uint8_t>(100, 255)});
  EXPECT_THROW(FrontEnd(rig, FrontEndParams{}), std::invalid_argument);
}

}  // namespace
}  // namespace lintel
