// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/PinholeRadtan.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// Round numbers, so that the expectations can be worked out by hand.
const PinholeRadtan kSimple{640, 480, 400, 300, 320, 240, 0.1, 0.01, 0.001, 0.002};

// cam0 of the EuRoC recordings.
const PinholeRadtan kEuroc{752,     480,         458.654,    457.296,    367.215,
                           248.375, -0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};

TEST(PinholeRadtan, DistortsByHand) {
  // r2 = 0.3125, radial = 1.0322265625
  const Vector2d d = kSimple.distort({0.5, -0.25});
  EXPECT_NEAR(d.x(), 0.51748828125, 1e-15);
  EXPECT_NEAR(d.y(), -0.258119140625, 1e-15);
}

TEST(PinholeRadtan, ProjectsByHand) {
  const Vector2d px = kSimple.project({1, -0.5, 2});
  EXPECT_NEAR(px.x(), 526.9953125, 1e-12);
  EXPECT_NEAR(px.y(), 162.5642578125, 1e-12);
}

TEST(PinholeRadtan, UndistortInvertsDistortOverTheWholeImage) {
  for (int v = 0; v <= 479; v += 20)
    for (int u = 0; u <= 751; u += 20) {
      const Vector2d px(u, v);
      EXPECT_LE((kEuroc.toPixel(kEuroc.normalise(px)) - px).norm(), 1e-9) << u << " " << v;
    }
}

TEST(PinholeRadtan, UndistortStaysFiniteWhereTheModelIsNotInvertible) {
  EXPECT_TRUE(kEuroc.undistort({5, -4}).allFinite());
}

TEST(PinholeRadtan, JacobianIsTheDerivative) {
  const double step = 1e-6;
  for (const PinholeRadtan& camera : {kSimple, kEuroc})
    for (double x = -0.8; x <= 0.8; x += 0.2)
      for (double y = -0.5; y <= 0.5; y += 0.25) {
        const Vector2d n(x, y), dx(step, 0), dy(0, step);
        Matrix2d numeric;
        numeric.col(0) = (camera.distort(n + dx) - camera.distort(n - dx)) / (2 * step);
        numeric.col(1) = (camera.distort(n + dy) - camera.distort(n - dy)) / (2 * step);
        EXPECT_LE((camera.distortJacobian(n) - numeric).norm(), 1e-8) << x << " " << y;
      }
}

TEST(PinholeRadtan, ContainsPixelsFromCentreToCentre) {
  EXPECT_TRUE(kSimple.contains({0, 0}));
  EXPECT_TRUE(kSimple.contains({639, 479}));
  EXPECT_FALSE(kSimple.contains({639.1, 100}));
  EXPECT_FALSE(kSimple.contains({-0.1, 100}));
  EXPECT_FALSE(kSimple.contains({4, 100}, 5));
  EXPECT_TRUE(kSimple.contains({5, 474}, 5));
}

}  // namespace
}  // namespace lintel
