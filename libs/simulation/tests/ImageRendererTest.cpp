// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/ImageRenderer.h"

#include <gtest/gtest.h>

#include "lintel/simulation/EurocRig.h"

namespace lintel {
namespace {

/// A dark square of 1 m before a light wall, evenly lit; the camera (looking along world z, 3 m away) sees both.
Scene squareBeforeWall() {
  Scene scene;
  Material paint;
  paint.resolution_px = 64;
  paint.tile_m = 4;
  paint.albedo = 0.9;
  scene.materials = {paint, paint};
  scene.materials[1].albedo = 0.1;
  scene.ambient = 1;
  scene.patches.push_back({{-20, -20, 3.001}, {0, 40, 0}, {40, 0, 0}, false, 0, 1, {0, 0}});
  scene.patches.push_back({{-0.5, -0.5, 3}, {0, 1, 0}, {1, 0, 0}, false, 1, 1, {0, 0}});
  scene.lines.push_back({{{-0.5, -0.5, 3}, {0.5, -0.5, 3}}, "edge"});
  scene.lines.push_back({{{-0.5, -0.5, 3.5}, {0.5, -0.5, 3.5}}, "behind the wall"});
  scene.lines.push_back({{{-0.5, -0.5, -3}, {0.5, -0.5, -3}}, "behind the camera"});
  return scene;
}

// Where the grey changes, found by the share of light and dark along a row, against the camera model's projection.
TEST(ImageRenderer, EdgesAreWhereTheCameraModelSays) {
  const Camera camera = eurocRig().camera;
  const Radiance image = ImageRenderer(squareBeforeWall(), camera).render(Pose{});
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
  };
  for (const double y : {-0.3, 0.0, 0.3}) {
    for (const double side : {-0.5, 0.5}) {
      const Eigen::Vector2d edge = camera.project({side, y, 3.0});
      const int row = static_cast<int>(std::lround(edge.y()));
      // the edge is nearly straight and upright: at the row's own height it is where it is at `row`
      const Eigen::Vector2d at_row = camera.project({side, y + (row - edge.y()) * 3.0 / camera.fy, 3.0});
      const int first = static_cast<int>(at_row.x()) - 8, last = first + 17;
      const float dark = image[at(side < 0 ? last : first, row)];
      const float light = image[at(side < 0 ? first : last, row)];
      ASSERT_GT(light, 4 * dark);
      double light_pixels = 0;
      for (int x = first; x <= last; ++x) {
        light_pixels += (image[at(x, row)] - dark) / (light - dark);
      }
      const double found = side < 0 ? first - 0.5 + light_pixels : last + 0.5 - light_pixels;
      EXPECT_NEAR(found, at_row.x(), 0.2) << "row " << row;  // paint has 10 % of texture
    }
  }
}

TEST(ImageRenderer, HiddenLinesAreNotSeen) {
  const ImageRenderer renderer(squareBeforeWall(), eurocRig().camera);
  EXPECT_EQ(renderer.visibleLines(Pose{}), (std::vector<bool>{true, false, false}));
}

TEST(ImageRenderer, TwoRendersAreEqual) {
  const ImageRenderer renderer(squareBeforeWall(), eurocRig().camera);
  EXPECT_EQ(renderer.render(Pose{}), renderer.render(Pose{}));
}

TEST(ImageRenderer, RowsHaveTheirOwnPoses) {
  const Camera camera = eurocRig().camera;
  const ImageRenderer renderer(squareBeforeWall(), camera);
  const Pose upper, lower{Eigen::Quaterniond::Identity(), {0.1, 0, 0}};
  const Radiance both = renderer.render([&](int row) { return row < 240 ? upper : lower; });
  const Radiance of_upper = renderer.render(upper), of_lower = renderer.render(lower);
  const auto row = [&](const Radiance& image, int y) {
    return Radiance(image.begin() + std::ptrdiff_t{y} * camera.width,
                    image.begin() + std::ptrdiff_t{y + 1} * camera.width);
  };
  EXPECT_EQ(row(both, 230), row(of_upper, 230));
  EXPECT_EQ(row(both, 250), row(of_lower, 250));
  EXPECT_NE(row(both, 250), row(of_upper, 250));
}

}  // namespace
}  // namespace lintel
