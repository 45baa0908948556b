// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/Rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lintel {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const std::vector<Vector3d> kRotationVectors = {
    {0, 0, 0},        {1e-9, -2e-9, 3e-9}, {7e-6, 0, -7e-6}, {1.1e-5, 2e-6, 0},
    {0.1, -0.2, 0.3}, {0, 0, M_PI / 2},    {1.5, -2.0, 1.0}, {0, 3.1, 0},
};

TEST(Rotation, SkewIsTheCrossProduct) { EXPECT_EQ(skew({1, 2, 3}) * Vector3d(4, 5, 6), Vector3d(-3, 6, -3)); }

TEST(Rotation, ExpTurnsAboutItsAxis) {
  EXPECT_TRUE((expRotation({0, 0, M_PI / 2}) * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-15));
  EXPECT_NEAR(expRotation({1e-9, 0, 0}).x(), 0.5e-9, 1e-24);
}

TEST(Rotation, LogOfAThirdOfATurn) {
  const double component = 2 * M_PI / 3 / std::sqrt(3.0);  // 120 degrees about (1, 1, 1)
  const Quaterniond q(0.5, 0.5, 0.5, 0.5), negated(-0.5, -0.5, -0.5, -0.5);
  EXPECT_TRUE(logRotation(q).isApprox(Vector3d::Constant(component), 1e-15));
  EXPECT_TRUE(logRotation(negated).isApprox(Vector3d::Constant(component), 1e-15));
}

TEST(Rotation, LogInvertsExp) {
  for (const Vector3d& phi : kRotationVectors)
    EXPECT_LE((logRotation(expRotation(phi)) - phi).norm(), 4e-15) << phi.transpose();
  const Vector3d nearly_half_turn = (M_PI - 1e-8) * Vector3d(1, 2, -2) / 3;
  EXPECT_LE((logRotation(expRotation(nearly_half_turn)) - nearly_half_turn).norm(), 1e-14);
}

TEST(Rotation, RightJacobianOfAQuarterTurnAboutZ) {
  const double c = 2 / M_PI;  // sin(a) / a = (1 - cos(a)) / a for a = pi / 2
  Matrix3d expected;
  expected << c, c, 0, -c, c, 0, 0, 0, 1;
  EXPECT_TRUE(rightJacobian({0, 0, M_PI / 2}).isApprox(expected, 1e-15));
}

TEST(Rotation, RightJacobianIsTheDerivative) {
  const double step = 1e-6;
  for (const Vector3d& phi : kRotationVectors) {
    Matrix3d numeric;
    for (int k = 0; k < 3; ++k) {
      const Vector3d d = step * Vector3d::Unit(k);
      numeric.col(k) = logRotation(expRotation(phi - d).conjugate() * expRotation(phi + d)) / (2 * step);
    }
    EXPECT_LE((rightJacobian(phi) - numeric).norm(), 1e-8) << phi.transpose();
  }
}

TEST(Rotation, RightJacobianInverse) {
  for (const Vector3d& phi : kRotationVectors)
    EXPECT_LE((rightJacobian(phi) * rightJacobianInverse(phi) - Matrix3d::Identity()).norm(), 1e-10) << phi.transpose();
  EXPECT_TRUE(rightJacobianInverse({M_PI, 0, 0}).allFinite());
}

TEST(Rotation, BetweenDirections) {
  EXPECT_TRUE((rotationBetween({2, 0, 0}, {0, 5, 0}) * Vector3d::UnitX()).isApprox(Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE((rotationBetween({2, 0, 0}, {0, 5, 0}) * Vector3d::UnitZ()).isApprox(Vector3d::UnitZ(), 1e-15));
  EXPECT_TRUE((rotationBetween({1, 0, 0}, {-1, 0, 0}) * Vector3d::UnitX()).isApprox(-Vector3d::UnitX(), 1e-15));
  for (const double off : {1e-12, 1e-8, 1e-5}) {
    const Vector3d nearly_opposite = Vector3d(-1, off, 0).normalized();
    EXPECT_TRUE((rotationBetween({1, 0, 0}, nearly_opposite) * Vector3d::UnitX()).isApprox(nearly_opposite, 1e-9));
  }
}

TEST(Rotation, YawIsWhatATurnAboutTheVerticalAdds) {
  // also for a body whose x axis points up, as that of EuRoC's sensor, where the heading of x means nothing
  for (const Vector3d& tilt : {Vector3d(0, 0, 0), Vector3d(0.2, -0.3, 0), Vector3d(0, -1.55, 0)}) {
    const Quaterniond before = expRotation(tilt), after = expRotation({0, 0, 0.5}) * before;
    EXPECT_NEAR(yawOf(after) - yawOf(before), 0.5, 1e-12);
  }
  EXPECT_NEAR(yawOf(expRotation({0, 0, 0.5})), 0.5, 1e-15);
  EXPECT_NEAR(yawOf(expRotation({0.3, -0.2, 0})), 0, 1e-15);
}

TEST(Rotation, TangentBasisIsOrthonormal) {
  for (const Vector3d& d : std::vector<Vector3d>{{0, 0, 2}, {1, 0, 0}, {0, -3, 0}, {1, 1, 1}, {-0.1, 5, 1e-9}}) {
    Matrix3d frame;
    frame << tangentBasis(d), d.normalized();
    EXPECT_TRUE((frame.transpose() * frame).isApprox(Matrix3d::Identity(), 1e-14)) << d.transpose();
  }
}

}  // namespace
}  // namespace lintel
