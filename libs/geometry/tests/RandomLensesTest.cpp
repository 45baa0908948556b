// SPDX-License-Identifier: BSD-3-Clause
// What holds for every lens, of lenses drawn at random: as strong as are sold, and some that nobody would build.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lintel/geometry/Camera.h"
#include "lintel/geometry/LensNames.h"

namespace lintel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr LensModel kModels[] = {LensModel::kRadialTangential, LensModel::kRational, LensModel::kEquidistant,
                                 LensModel::kDoubleSphere, LensModel::kExtendedUnified};

class RandomLenses : public testing::TestWithParam<LensModel> {
 protected:
  static constexpr int kLenses = 60, kRays = 150;

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max());
  }

  Camera lens() {
    Camera c;
    c.model = GetParam();
    c.width = static_cast<int>(between(160, 2000));
    c.height = static_cast<int>(between(120, 1500));
    c.fx = c.width * (c.wide() ? between(0.2, 0.6) : between(0.35, 1.5));
    c.fy = c.fx * between(0.9, 1.1);
    c.cx = c.width * between(0.4, 0.6);
    c.cy = c.height * between(0.4, 0.6);
    switch (c.model) {
      case LensModel::kRadialTangential:
        c.lens = {between(-0.45, 0.3), between(-0.3, 0.3), between(-0.003, 0.003), between(-0.003, 0.003),
                  between(-0.15, 0.15)};
        break;
      case LensModel::kRational: {  // a denominator without a zero, and a numerator near it
        const double k4 = between(0, 0.4), k5 = between(0, 0.4), k6 = between(0, 0.3);
        c.lens = {k4 + between(-0.35, 0.1),
                  k5 + between(-0.1, 0.1),
                  between(-0.003, 0.003),
                  between(-0.003, 0.003),
                  k6 + between(-0.05, 0.05),
                  k4,
                  k5,
                  k6};
        break;
      }
      case LensModel::kEquidistant:
        c.lens = {between(-0.1, 0.1), between(-0.05, 0.05), between(-0.02, 0.02), between(-0.005, 0.005)};
        break;
      case LensModel::kDoubleSphere:
        c.lens = {between(-0.3, 0.5), between(0.1, 0.9)};
        break;
      case LensModel::kExtendedUnified:
        c.lens = {between(0.1, 0.9), between(0.5, 2)};
        break;
    }
    return c;
  }

  /// Somewhere before the camera, a little of it behind.
  Vector3d point() {
    const double angle = between(0, 1.9), turn = between(0, 6.3), distance = std::exp(between(-2, 5));
    return distance * Vector3d(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle));
  }

  std::string describe(const Camera& c) const {
    std::string text = lensName(c.model).name + std::string(": ") + std::to_string(c.width) + " x " +
                       std::to_string(c.height) + ", f " + std::to_string(c.fx) + " " + std::to_string(c.fy) + ", c " +
                       std::to_string(c.cx) + " " + std::to_string(c.cy) + ", lens";
    for (const double k : c.lens) text += " " + std::to_string(k);
    return text;
  }

  std::mt19937 random_{20};
};

TEST_P(RandomLenses, APointThatProjectsIntoTheImageIsFoundAgain) {
  int found = 0;
  for (int i = 0; i < kLenses; ++i) {
    const Camera camera = lens();
    for (int k = 0; k < kRays; ++k) {
      const Vector3d p_c = point();
      if (!camera.projects(p_c)) continue;
      const Vector2d px = camera.project(p_c);
      ASSERT_TRUE(px.allFinite()) << describe(camera) << ", point " << p_c.transpose();
      if (!camera.contains(px)) continue;
      Vector3d ray;
      ASSERT_TRUE(camera.unproject(px, ray)) << describe(camera) << ", point " << p_c.transpose();
      EXPECT_LE((ray - camera.rayTo(p_c)).norm(), 1e-5 * ray.norm()) << describe(camera) << ", " << p_c.transpose();
      ++found;
    }
  }
  EXPECT_GT(found, kLenses * kRays / 20) << "few of the points were in the images: the test says little";
}

TEST_P(RandomLenses, ARayThatIsFoundProjectsIntoItsPixel) {
  int found = 0;
  for (int i = 0; i < kLenses; ++i) {
    const Camera camera = lens();
    for (int k = 0; k < kRays; ++k) {
      const Vector2d px(camera.width * between(-0.5, 1.5), camera.height * between(-0.5, 1.5));
      Vector3d ray;
      const bool seen = camera.unproject(px, ray);
      ASSERT_TRUE(ray.allFinite()) << describe(camera) << ", pixel " << px.transpose();
      if (!seen) continue;
      ASSERT_TRUE(camera.projects(ray)) << describe(camera) << ", pixel " << px.transpose();
      EXPECT_LE((camera.project(ray) - px).norm(), 1e-5) << describe(camera) << ", pixel " << px.transpose();
      ++found;
    }
  }
  EXPECT_GT(found, kLenses * kRays / 10) << "few of the pixels were seen: the test says little";
}

TEST_P(RandomLenses, DerivativesByThePointAreNumericOnes) {
  for (int i = 0; i < kLenses; ++i) {
    const Camera camera = lens();
    for (int k = 0; k < kRays; ++k) {
      const Vector3d p_c = point().normalized();
      if (!camera.projects(p_c) || !camera.contains(camera.project(p_c))) continue;
      PixelJacobians scaled;
      camera.project(p_c, 1, scaled);
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = 1e-6 * Vector3d::Unit(axis);
        if (!camera.projects(p_c + step) || !camera.projects(p_c - step)) continue;
        const Vector2d numeric = (camera.project(p_c + step) - camera.project(p_c - step)) / 2e-6;
        EXPECT_LE((scaled.point.col(axis) - numeric).norm(), 1e-4 * (1 + numeric.norm()))
            << describe(camera) << ", point " << p_c.transpose();
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, RandomLenses, testing::ValuesIn(kModels), [](const auto& lens) {
  std::string name = lensName(lens.param).name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

}  // namespace
}  // namespace lintel
