// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "lintel/geometry/LensNames.h"

namespace lintel {

std::ostream& operator<<(std::ostream& out, const Camera& camera) { return out << lensName(camera.model).name; }

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Round numbers, so that the expectations can be worked out by hand.
const Camera kSimple{640, 480, 400, 300, 320, 240, {0.1, 0.01, 0.001, 0.002}};

// cam0 of the EuRoC recordings.
const Camera kEuroc{
    752, 480, 458.654, 457.296, 367.215, 248.375, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}};

const Camera kUndistorted{640, 480, 400, 410, 320, 240, {}};
const Camera kSixth{1280, 720, 610, 612, 640, 360, {0.1056, -0.2142, 0.0003, -0.0002, 0.0775}};
const Camera kRational{1280,
                       720,
                       607.3,
                       607.1,
                       641.6,
                       365.2,
                       {0.4562, -2.5631, 0.00081, -0.00036, 1.4893, 0.3312, -2.3861, 1.4175},
                       LensModel::kRational};

// TUM-VI's cam0 [Schubert2018]: a published equidistant calibration of 512 x 512 pixels.
const Camera kTumVi{512,
                    512,
                    190.97847715128717,
                    190.9733070521226,
                    254.93170605935475,
                    256.8974428996504,
                    {0.0034823894022493434, 0.0007150348452162257, -0.0020532361418706202, 0.00020293673591811182},
                    LensModel::kEquidistant};
// The same lens in the models of Basalt [Usenko2018].
const Camera kTumViDs{512, 512, 156.6, 156.6, 254.9, 256.9, {-0.1755, 0.5929}, LensModel::kDoubleSphere};
const Camera kTumViEucm{512, 512, 190.9, 190.9, 254.9, 256.9, {0.63, 1.04}, LensModel::kExtendedUnified};

std::vector<Vector3d> raysUpTo(double angle_rad) {
  std::vector<Vector3d> rays{Vector3d::UnitZ(), Vector3d(1e-9, -2e-9, 1).normalized()};
  for (double theta = 0.05; theta <= angle_rad; theta += 0.1)
    for (double phi = 0; phi < 6.28; phi += 0.4)
      rays.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  return rays;
}

class AnyCamera : public testing::TestWithParam<Camera> {
 protected:
  double angle() const { return GetParam().wide() ? 1.7 : 0.6; }  // 97 degrees: 7 behind the lens
};

TEST_P(AnyCamera, ARayOfAnyPixelOfTheImageGoesBackThere) {
  const Camera& camera = GetParam();
  for (int v = 0; v < camera.height; v += 20)
    for (int u = 0; u < camera.width; u += 20) {
      Vector3d ray;
      ASSERT_TRUE(camera.unproject(Vector2d(u, v), ray)) << u << " " << v;
      EXPECT_EQ(ray, camera.ray(Vector2d(u, v)));
      EXPECT_NEAR(camera.wide() ? ray.norm() : ray.z(), 1, 1e-12);
      EXPECT_TRUE(camera.projects(ray)) << u << " " << v;
      EXPECT_LE((camera.project(ray) - Vector2d(u, v)).norm(), 1e-8) << u << " " << v;
      EXPECT_LE((camera.project(3 * ray) - Vector2d(u, v)).norm(), 1e-8) << u << " " << v;
    }
}

TEST_P(AnyCamera, TheRayToAPointIsTheRayOfItsPixel) {
  const Camera& camera = GetParam();
  for (const Vector3d& direction : raysUpTo(angle())) {
    const Vector3d p_c = 2.5 * direction;
    ASSERT_TRUE(camera.projects(p_c)) << p_c.transpose();
    EXPECT_LE((camera.ray(camera.project(p_c)) - camera.rayTo(p_c)).norm(), 1e-8) << p_c.transpose();
  }
}

TEST_P(AnyCamera, DerivativesByThePointAreNumericOnes) {
  const Camera& camera = GetParam();
  for (const Vector3d& direction : raysUpTo(angle())) {
    const Vector3d p_c = 2.5 * direction;
    PixelJacobians scaled;
    const Vector2d px = camera.project(p_c, 0.5, scaled);
    EXPECT_LE((px - camera.project(p_c)).norm(), 1e-10);
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = 1e-6 * Vector3d::Unit(k);
      const Vector2d numeric = (camera.project(p_c + step) - camera.project(p_c - step)) / 2e-6;
      EXPECT_LE((scaled.point.col(k) / 0.5 - numeric).norm(), 1e-5 * (1 + numeric.norm())) << p_c.transpose();
    }
  }
}

TEST_P(AnyCamera, DerivativesByTheIntrinsicsAreNumericOnes) {
  const Camera& camera = GetParam();
  for (const Vector3d& p_c : raysUpTo(angle())) {
    PixelJacobians scaled;
    camera.project(p_c, 2, scaled);
    for (int k = 0; k < kIntrinsicsSize; ++k) {
      Camera more = camera, less = camera;
      more.intrinsic(k) += 1e-6;
      less.intrinsic(k) -= 1e-6;
      const Vector2d numeric = (more.project(p_c) - less.project(p_c)) / 2e-6;
      EXPECT_LE((scaled.intrinsics.col(k) / 2 - numeric).norm(), 1e-5 * (1 + numeric.norm())) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses, AnyCamera,
                         testing::Values(kSimple, kEuroc, kUndistorted, kSixth, kRational, kTumVi, kTumViDs,
                                         kTumViEucm));

/// Pixels of OpenCV's functions for the camera.
std::vector<cv::Point2d> byOpenCv(const Camera& camera, const std::vector<Vector3d>& points) {
  std::vector<cv::Point3d> from;
  from.reserve(points.size());
  for (const Vector3d& p : points) from.emplace_back(p.x(), p.y(), p.z());
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Vec3d none(0, 0, 0);
  std::vector<cv::Point2d> px;
  if (camera.wide())
    cv::fisheye::projectPoints(from, px, none, none, K, cv::Vec4d(camera.lens.data()));
  else
    cv::projectPoints(from, none, none, K, std::vector<double>(camera.lens.begin(), camera.lens.end()), px);
  return px;
}

TEST(Camera, AgreesWithOpenCv) {
  for (const Camera& camera : {kSimple, kEuroc, kUndistorted, kSixth, kRational, kTumVi}) {
    const std::vector<Vector3d> points = raysUpTo(camera.wide() ? 1.5 : 0.6);  // OpenCV's fisheye needs z > 0
    const std::vector<cv::Point2d> expected = byOpenCv(camera, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2d px = camera.project(points[i]);
      EXPECT_NEAR(px.x(), expected[i].x, 1e-6) << camera << " " << points[i].transpose();
      EXPECT_NEAR(px.y(), expected[i].y, 1e-6) << camera << " " << points[i].transpose();
    }
  }
}

TEST(Camera, EquidistantByHand) {
  const Camera camera{640, 480, 100, 200, 320, 240, {}, LensModel::kEquidistant};
  const Vector2d sideways = camera.project({5, 0, 0}), behind = camera.project({0, 1, -1});
  EXPECT_NEAR(sideways.x(), 320 + 100 * M_PI / 2, 1e-10);
  EXPECT_NEAR(sideways.y(), 240, 1e-10);
  EXPECT_NEAR(behind.y(), 240 + 200 * 3 * M_PI / 4, 1e-10);
}

TEST(Camera, SphereModelsByHand) {
  // xi = 0 and alpha = 0.5: (x, y) / (0.5 |p| + 0.5 z), which is the unified model of the same alpha with beta = 1
  const Camera ds{640, 480, 100, 100, 320, 240, {0, 0.5}, LensModel::kDoubleSphere};
  const Camera eucm{640, 480, 100, 100, 320, 240, {0.5, 1}, LensModel::kExtendedUnified};
  EXPECT_NEAR(ds.project({3, 0, 4}).x(), 320 + 100 * 3 / 4.5, 1e-12);
  for (const Vector3d& p : raysUpTo(1.7)) EXPECT_LE((ds.project(p) - eucm.project(p)).norm(), 1e-9);
}

TEST(Camera, DirectionsThatALensCannotSee) {
  EXPECT_FALSE(kEuroc.projects({0, 0, -1}));
  Camera folding = kEuroc;
  folding.lens = {-0.3};  // the image of a growing angle turns back at (x/z)^2 + (y/z)^2 = 1 / 0.9
  EXPECT_TRUE(folding.projects({1, 0, 1}));
  EXPECT_FALSE(folding.projects({1.1, 0, 1}));
  EXPECT_FALSE(folding.projects({5, -4, 1}));
  EXPECT_FALSE(kTumViDs.projects({0, 0.2, -1}));
  EXPECT_FALSE(kTumViEucm.projects({0, 0.2, -1}));
  EXPECT_FALSE(kTumVi.projects({0, 0, -1}));
  Vector3d ray;
  EXPECT_FALSE(kTumVi.unproject({5000, 5000}, ray));
  EXPECT_TRUE(ray.allFinite());
  EXPECT_FALSE(kTumViDs.unproject({5000, 5000}, ray));
  EXPECT_TRUE(ray.allFinite());
}

TEST(Camera, LargestAngleOfTheImage) {
  EXPECT_NEAR(largestAngle(kUndistorted), std::atan(std::hypot(320 / 400., 240 / 410.)), 1e-12);
  EXPECT_GT(largestAngle(kTumVi), M_PI / 2);
}

TEST(Camera, DistortsByHand) {
  // r2 = 0.3125, radial = 1.0322265625
  const Vector2d d = kSimple.distort({0.5, -0.25});
  EXPECT_NEAR(d.x(), 0.51748828125, 1e-15);
  EXPECT_NEAR(d.y(), -0.258119140625, 1e-15);
}

TEST(Camera, ProjectsByHand) {
  const Vector2d px = kSimple.project({1, -0.5, 2});
  EXPECT_NEAR(px.x(), 526.9953125, 1e-12);
  EXPECT_NEAR(px.y(), 162.5642578125, 1e-12);
}

TEST(Camera, UndistortFromAPlaceNearEndsWhereItDoesOtherwise) {
  for (const Eigen::Vector2d& px : {Eigen::Vector2d(10, 20), Eigen::Vector2d(400, 250), Eigen::Vector2d(740, 470)}) {
    const Eigen::Vector2d expected = kEuroc.normalise(px);
    EXPECT_LT((kEuroc.normalise(px, expected + Eigen::Vector2d(0.02, -0.01)) - expected).norm(), 1e-11);
    EXPECT_LT((kEuroc.normalise(px, expected) - expected).norm(), 1e-11);
  }
}

TEST(Camera, UndistortStaysFiniteWhereTheModelIsNotInvertible) { EXPECT_TRUE(kEuroc.undistort({5, -4}).allFinite()); }

TEST(Camera, JacobianOfTheDistortionIsTheDerivative) {
  const double step = 1e-6;
  for (const Camera& camera : {kSimple, kEuroc, kSixth})
    for (double x = -0.8; x <= 0.8; x += 0.2)
      for (double y = -0.5; y <= 0.5; y += 0.25) {
        const Vector2d n(x, y), dx(step, 0), dy(0, step);
        Matrix2d numeric;
        numeric.col(0) = (camera.distort(n + dx) - camera.distort(n - dx)) / (2 * step);
        numeric.col(1) = (camera.distort(n + dy) - camera.distort(n - dy)) / (2 * step);
        EXPECT_LE((camera.distortJacobian(n) - numeric).norm(), 1e-8) << x << " " << y;
      }
}

TEST(Camera, ContainsPixelsFromCentreToCentre) {
  EXPECT_TRUE(kSimple.contains({0, 0}));
  EXPECT_TRUE(kSimple.contains({639, 479}));
  EXPECT_FALSE(kSimple.contains({639.1, 100}));
  EXPECT_FALSE(kSimple.contains({-0.1, 100}));
  EXPECT_FALSE(kSimple.contains({4, 100}, 5));
  EXPECT_TRUE(kSimple.contains({5, 474}, 5));
}

TEST(LensNames, ANameComesBack) {
  for (const LensModel model : {LensModel::kRadialTangential, LensModel::kRational, LensModel::kEquidistant,
                                LensModel::kDoubleSphere, LensModel::kExtendedUnified})
    EXPECT_EQ(lensModel(lensName(model).name), model);
  EXPECT_EQ(lensModel("plumb_bob"), LensModel::kRadialTangential);
  EXPECT_FALSE(lensModel("omni"));
}

TEST(LensNames, TheNumberOfCoefficientsIsChecked) {
  Camera camera;
  EXPECT_TRUE(setLens(camera, LensModel::kRadialTangential, {1, 2, 3, 4}));
  EXPECT_EQ(lensCoefficients(camera), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_TRUE(setLens(camera, LensModel::kRadialTangential, {1, 2, 3, 4, 5}));
  EXPECT_EQ(lensCoefficients(camera).size(), 5u);
  EXPECT_FALSE(setLens(camera, LensModel::kEquidistant, {1, 2, 3}));
  EXPECT_EQ(camera.model, LensModel::kRadialTangential);
  EXPECT_TRUE(setLens(camera, LensModel::kDoubleSphere, {-0.2, 0.6}));
  EXPECT_EQ(camera.lens[2], 0);
}

}  // namespace
}  // namespace lintel
