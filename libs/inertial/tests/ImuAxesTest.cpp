// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/ImuAxes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

const Eigen::Vector3d kMean_f(0.5, -0.8, 9.6);

Preintegration turning() {
  ImuBatch samples;
  for (int i = 0; i <= 60; ++i) {
    const double t = 0.005 * i;
    samples.push_back({1'400'000'000'000'000'000 + i * std::int64_t{5'000'000},
                       {2 * std::sin(3 * t), 0.3, -1.5 * std::cos(4 * t)},
                       {2 * std::cos(t), -1 + t, 9.5 + std::sin(5 * t)}});
  }
  Preintegration imu({{0.02, -0.01, 0.03}, {0.1, 0.2, -0.1}}, {});
  imu.append(samples);
  return imu;
}

TEST(ImuAxes, OfASensorThatStandsStillTheyAddToWhatItMeasures) {
  Preintegration imu({}, {});
  for (int i = 0; i <= 100; ++i) imu.append({{i * std::int64_t{10'000'000}, {0, 0, 0}, {1, 2, 10}}});
  ImuAxes axes;
  axes.A(1, 2) = 0.03;  // y shows 3 % less than it should of what is along z
  const Preintegration corrected = withAxes(imu, axes);
  EXPECT_TRUE(corrected.deltaV().isApprox(Eigen::Vector3d(1, 2.3, 10), 1e-12));
  EXPECT_TRUE(corrected.deltaP().isApprox(Eigen::Vector3d(0.5, 1.15, 5), 1e-12));
  axes.mean_f = {1, 2, 10};
  EXPECT_TRUE(withAxes(imu, axes).deltaV().isApprox(Eigen::Vector3d(1, 2, 10), 1e-12)) << "a bias may be all of it";
}

/// By numeric differences.
TEST(ImuAxes, TheJacobianByTheGyroscopesAxesIsThatOfTheDeltas) {
  const Preintegration imu = turning();
  const Preintegration::AxesJacobian J = imu.axesJacobian(kMean_f);
  constexpr double kStep = 1e-5;
  const std::pair<int, int> elements[] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int i = 0; i < 6; ++i) {
    const auto moved = [&](double step) {
      ImuAxes axes;
      axes.G(elements[i].first, elements[i].second) = axes.G(elements[i].second, elements[i].first) = step;
      return withAxes(imu, axes);
    };
    const Preintegration more = moved(kStep), less = moved(-kStep);
    Eigen::Matrix<double, 9, 1> numeric;
    numeric << logRotation(less.deltaR().conjugate() * more.deltaR()), more.deltaV() - less.deltaV(),
        more.deltaP() - less.deltaP();
    numeric /= 2 * kStep;
    EXPECT_LT((J.col(9 + i) - numeric).norm(), 1e-6 * numeric.norm()) << i;
  }
}

/// Not only to first order.
TEST(ImuAxes, TheJacobianGivesTheDeltasOfAnyAxes) {
  const Preintegration imu = turning();
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> A;
  A << 0.1, -0.2, 0.05, 0.3, -0.1, 0.15, -0.02, 0.4, 0.2;
  const Eigen::Matrix<double, 6, 1> change =
      imu.axesJacobian(kMean_f).bottomLeftCorner<6, 9>() * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(A.data());
  const Preintegration corrected = withAxes(imu, {A, kMean_f});
  EXPECT_GT((corrected.deltaV() - imu.deltaV()).norm(), 0.1);
  EXPECT_TRUE(corrected.deltaV().isApprox(imu.deltaV() + change.head<3>(), 1e-12));
  EXPECT_TRUE(corrected.deltaP().isApprox(imu.deltaP() + change.tail<3>(), 1e-12));
}

TEST(ImuAxes, FollowedByOthersTheyAreOne) {
  Eigen::Matrix3d first, second;
  first << 0.1, -0.2, 0.05, 0.3, -0.1, 0.15, -0.02, 0.4, 0.2;
  second << -0.05, 0.1, 0.02, 0.1, 0.3, -0.2, 0.2, -0.1, 0.05;
  const Preintegration imu = turning(), both = withAxes(withAxes(imu, {first, {0, 0, 0}}), {second, {0, 0, 0}});
  EXPECT_TRUE(both.deltaP().isApprox(withAxes(imu, {followedBy(first, second), {0, 0, 0}}).deltaP(), 1e-12));
}

TEST(ImuAxes, NothingElseOfTheIntervalChanges) {
  Preintegration imu = turning();
  imu.setStampNoise(0.001, 1e-4 * Preintegration::Matrix9::Identity());
  const Preintegration same = withAxes(imu, {});
  EXPECT_EQ(same.deltaP(), imu.deltaP());
  EXPECT_EQ(same.covariance(), imu.covariance());
  EXPECT_EQ(same.stampSigma(), imu.stampSigma());
  EXPECT_EQ(same.bias().accel, imu.bias().accel);
}

}  // namespace
}  // namespace lintel
