// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/tracking/TrackDrawing.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "TestImages.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

TEST(TrackDrawing, drawsPointsAndLinesInColour) {
  const Rig rig = testing::testRig();
  const Frame frame = testing::renderScene(
      rig, [](const Eigen::Vector2d&) { return 50.0; }, 0);
  FrameTracks tracks;
  PointObservation point;
  point.id = 1;
  point.px = {100, 100};
  point.track_length = 2;
  tracks.points.push_back(point);
  LineObservation line;
  line.id = 2;
  line.start = {-0.2, 0.2, 1};
  line.end = {0.2, 0.2, 1};
  line.start_px = rig.camera.project(line.start);
  line.end_px = rig.camera.project(line.end);
  tracks.lines.push_back(line);

  const test::TempFolder folder;
  const std::string path = folder / "tracks.png";
  drawTracks(path, frame, rig, tracks);
  const cv::Mat drawn = cv::imread(path);
  ASSERT_EQ(drawn.cols, 2 * rig.camera.width);
  const auto coloured = [&](const Eigen::Vector2d& px) {
    const cv::Vec3b& c = drawn.at<cv::Vec3b>(static_cast<int>(2 * px.y()), static_cast<int>(2 * px.x()));
    return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}) > 100;
  };
  EXPECT_TRUE(coloured(point.px));
  EXPECT_TRUE(coloured(rig.camera.project({-0.15, 0.2, 1})));
  EXPECT_FALSE(coloured({300, 40}));
}

TEST(TrackDrawing, namesTheFileItCannotWrite) {
  const Rig rig = testing::testRig();
  const Frame frame = testing::renderScene(
      rig, [](const Eigen::Vector2d&) { return 50.0; }, 0);
  try {
    drawTracks("/no/such/folder/x.png", frame, rig, {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/folder/x.png"), std::string::npos);
  }
}

}  // namespace
}  // namespace lintel
