// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lintel/exporting/Undistortion.h"

namespace lintel {
namespace {

Camera fisheye() {
  Camera camera{200, 160, 100, 100, 99.5, 79.5, {-0.01, 0.02}};
  camera.model = LensModel::kEquidistant;
  return camera;
}

Camera barrel() { return {200, 160, 180, 180, 99.5, 79.5, {-0.28, 0.07, 0.001, -0.002}}; }

class Undistortion : public testing::TestWithParam<Camera> {};

/// The grey level at every pixel of a scene at infinity, a smooth function of the direction of view: seen through the
/// lens and undistorted it is what the pinhole camera sees.
TEST_P(Undistortion, TheImageIsThePinholes) {
  const Camera camera = GetParam(), pinhole = pinholeOf(camera);
  const auto level = [](const Eigen::Vector3d& ray) {
    const Eigen::Vector3d d = ray.normalized();
    return 128 + 100 * d.x() * d.y() + 20 * d.x();
  };
  const auto taken = [&](const Camera& by) {
    GrayImage image{by.width, by.height, {}};
    for (int y = 0; y < by.height; ++y)
      for (int x = 0; x < by.width; ++x)
        image.pixels.push_back(static_cast<std::uint8_t>(std::lround(level(by.ray({x, y})))));
    return image;
  };
  const GrayImage seen = taken(camera), expected = taken(pinhole), result = ImageUndistorter(camera, pinhole)(seen);
  ASSERT_EQ(result.pixels.size(), expected.pixels.size());
  for (std::size_t i = 0; i < expected.pixels.size(); ++i)
    ASSERT_NEAR(result.pixels[i], expected.pixels[i], 1) << "pixel " << i;
}

TEST_P(Undistortion, ObservationsAreWhereThePinholeCameraSeesThem) {
  LineMap map;
  map.rig.camera = GetParam();
  const Eigen::Vector3d seen(0.3, -0.2, 1.0), beside(0.98, 0.1, 1.0), end(-0.3, 0.2, 1.2);
  MapPoint point;
  point.observations = {{7, map.rig.camera.project(seen)}, {8, map.rig.camera.project({2.5, 0.1, 1.0})}};
  map.points.push_back(point);
  MapLine line;
  MapLineObservation observation;
  observation.start_px = map.rig.camera.project(seen);
  observation.end_px = map.rig.camera.project(end);
  line.observations = {observation};
  map.lines.push_back(line);
  const LineMap moved = undistorted(map);
  const Camera& pinhole = moved.rig.camera;
  ASSERT_EQ(moved.points[0].observations.size(), 1u) << "the other lies outside the pinhole's image";
  EXPECT_EQ(moved.points[0].observations[0].keyframe_id, 7u);
  EXPECT_LT((moved.points[0].observations[0].px - pinhole.project(seen)).norm(), 1e-6);
  ASSERT_EQ(moved.lines[0].observations.size(), 1u);
  EXPECT_LT((moved.lines[0].observations[0].start_px - pinhole.project(seen)).norm(), 1e-6);
  EXPECT_LT((moved.lines[0].observations[0].end_px - pinhole.project(end)).norm(), 1e-6);
  EXPECT_NEAR(pinhole.fx, map.rig.camera.meanFocal(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Lenses, Undistortion, testing::Values(fisheye(), barrel()));

TEST(ImageUndistorter, RefusesAnImageOfAnotherSize) {
  const ImageUndistorter undistort(barrel(), pinholeOf(barrel()));
  EXPECT_THROW(undistort(GrayImage{2, 2, {1, 2, 3, 4}}), std::invalid_argument);
}

}  // namespace
}  // namespace lintel
