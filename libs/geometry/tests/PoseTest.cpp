// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Pose.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

const Pose kQuarterTurn{expRotation({0, 0, M_PI / 2}), {1, 2, 3}};
const Pose kOther{expRotation({0.3, -0.4, 1.0}), {-2, 0.5, 7}};

TEST(Pose, MapsPoints) { EXPECT_TRUE((kQuarterTurn * Vector3d(1, 0, 0)).isApprox(Vector3d(1, 3, 3), 1e-15)); }

TEST(Pose, CompositionMapsLikeOneAfterTheOther) {
  const Vector3d p(0.1, 0.2, -0.3);
  EXPECT_TRUE(((kQuarterTurn * kOther) * p).isApprox(kQuarterTurn * (kOther * p), 1e-14));
}

TEST(Pose, InverseUndoes) {
  const Pose nothing = kOther * kOther.inverse();
  EXPECT_LE(nothing.p.norm(), 1e-14);
  EXPECT_LE(logRotation(nothing.q).norm(), 1e-14);
  EXPECT_TRUE((kQuarterTurn.inverse() * Vector3d(1, 3, 3)).isApprox(Vector3d(1, 0, 0), 1e-14));
}

TEST(Pose, FromMatrixTakesTheNearestRotation) {
  Matrix4d M = Matrix4d::Identity();
  M.topLeftCorner<3, 3>() = 1.1 * kQuarterTurn.R();
  M.topRightCorner<3, 1>() = kQuarterTurn.p;
  const Pose T = poseFromMatrix(M);
  EXPECT_LE(T.q.angularDistance(kQuarterTurn.q), 1e-14);
  EXPECT_EQ(T.p, kQuarterTurn.p);
}

TEST(Pose, FromMirroredMatrixIsStillARotation) {
  Matrix4d M = Matrix4d::Identity();
  M(2, 2) = -1;
  EXPECT_NEAR(poseFromMatrix(M).R().determinant(), 1.0, 1e-14);
}

TEST(Pose, InterpolatesStraightAndAtEvenRate) {
  const Pose start, end{expRotation({0, 0, M_PI / 2}), {2, 0, -4}};
  const Pose quarter = interpolate(start, end, 0.25);
  EXPECT_TRUE(quarter.p.isApprox(Vector3d(0.5, 0, -1), 1e-15));
  EXPECT_TRUE(logRotation(quarter.q).isApprox(Vector3d(0, 0, M_PI / 8), 1e-14));
  EXPECT_EQ(interpolate(start, end, 1).p, end.p);
}

}  // namespace
}  // namespace lintel
