// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SurfaceDistance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

class SurfaceDistanceTest : public testing::Test {
 protected:
  std::string write(const std::string& text) const { return folder_.write("surface.ply", text); }

  test::TempFolder folder_;
};

constexpr const char* kSquareAndTriangle =
    "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar uint vertex_indices\nend_header\n"
    "0 0 0\n2 0 0\n2 2 0\n0 2 0\n5 0 0\n5 1 0\n5 0 1\n4 0 1 2 3\n3 4 5 6\n";

TEST_F(SurfaceDistanceTest, InsideASurfaceItIsThePlanesDistance) {
  const SurfaceDistance distance(write(kSquareAndTriangle));
  EXPECT_EQ(distance.triangles(), 3u);  // the square becomes two
  EXPECT_NEAR(distance({1, 1, 0.3}), 0.3, 1e-6);
  EXPECT_NEAR(distance({0.2, 1.9, -0.07}), 0.07, 1e-6);
  EXPECT_NEAR(distance({1, 1, 0}), 0, 1e-6);  // on the square's diagonal
}

TEST_F(SurfaceDistanceTest, BesideASurfaceItIsTheEdgesOrCorners) {
  const SurfaceDistance distance(write(kSquareAndTriangle));
  EXPECT_NEAR(distance({-0.5, 1, 0}), 0.5, 1e-6);
  EXPECT_NEAR(distance({-0.3, -0.4, 0}), 0.5, 1e-6);
  EXPECT_NEAR(distance({5.2, 0.7, 0.7}), std::hypot(0.2, 0.4 / std::sqrt(2.0)), 1e-6);
  EXPECT_TRUE(std::isinf(distance({0, 0, 50})));
}

TEST_F(SurfaceDistanceTest, WhatIsNoMeshIsNamed) {
  EXPECT_THROW(SurfaceDistance("/nonexistent/scene.ply"), std::runtime_error);
  EXPECT_THROW(SurfaceDistance(write("no mesh\n")), std::runtime_error);
}

}  // namespace
}  // namespace lintel
