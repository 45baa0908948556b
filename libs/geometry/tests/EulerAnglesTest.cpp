// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/EulerAngles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// Yaw, pitch, roll as MRPT's CPose3D defines them.
Eigen::Vector3d anglesOf(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d R = q.toRotationMatrix();
  return {std::atan2(R(1, 0), R(0, 0)), std::asin(-R(2, 0)), std::atan2(R(2, 1), R(2, 2))};
}

PoseCovariance someCovariance() {
  PoseCovariance root = PoseCovariance::Identity();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) root(i, j) = 0.1 * (i + 1) - 0.17 * j;
  return root * root.transpose();
}

TEST(EulerAngles, TurnACovarianceAsTheAnglesThemselvesChange) {
  const Eigen::Quaterniond q = expRotation({0.3, -0.6, 1.1});
  Eigen::Matrix3d by_theta;
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    by_theta.col(k) = (anglesOf(q * expRotation(step)) - anglesOf(q * expRotation(-step))) / (2 * kStep);
  }
  PoseCovariance by = PoseCovariance::Identity();
  by.bottomRightCorner<3, 3>() = by_theta;
  const PoseCovariance expected = by * someCovariance() * by.transpose();
  EXPECT_LT((toEulerCovariance(someCovariance(), q) - expected).norm(), 1e-6 * expected.norm());
}

TEST(EulerAngles, BackAndForthIsTheSame) {
  const Eigen::Quaterniond q = expRotation({0.1, -1.5, 0.2});
  const PoseCovariance there = toEulerCovariance(someCovariance(), q);
  EXPECT_LT((fromEulerCovariance(there, q) - someCovariance()).norm(), 1e-9);
}

TEST(EulerAngles, AVerticalAxisGivesLargeNumbersAndNoneThatIsNotFinite) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(-1.5707963267948966, Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(toEulerCovariance(someCovariance(), q).allFinite());
}

}  // namespace
}  // namespace lintel
