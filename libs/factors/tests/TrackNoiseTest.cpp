// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/TrackNoise.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace lintel {
namespace {

TEST(TrackNoise, WhiteNoiseIsOnlyScaled) {
  EXPECT_EQ(whitener({0.5, 0}, {0, 0.1, 0.7}), 2 * Eigen::Matrix3d::Identity());
}

TEST(TrackNoise, TwoObservationsByHand) {
  // variances 4 and 4 + 9 * 4, covariance 0: the walk begins with the first observation
  const Eigen::MatrixXd W = whitener({2, 3}, {1, 5});
  EXPECT_NEAR(W(0, 0), 0.5, 1e-15);
  EXPECT_NEAR(W(1, 1), 1 / std::sqrt(40.0), 1e-15);
  EXPECT_EQ(W(1, 0), 0);
  EXPECT_EQ(W(0, 1), 0);
}

TEST(TrackNoise, WhitenedErrorsAreIndependentAndOfUnitVariance) {
  const TrackNoise noise{0.3, 0.8};
  const std::vector<double> t_s = {0.2, 0.3, 0.7, 1.9, 2.0};
  Eigen::MatrixXd covariance(5, 5);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      covariance(i, j) = (i == j ? 0.09 : 0) + 0.64 * (t_s[static_cast<std::size_t>(std::min(i, j))] - 0.2);
  const Eigen::MatrixXd W = whitener(noise, t_s);
  EXPECT_TRUE((W * covariance * W.transpose()).isIdentity(1e-12));
  EXPECT_TRUE(W.isLowerTriangular());
}

TEST(TrackNoise, ASlideIsForgivenAndAJumpIsNot) {
  // the same step of one pixel: over a second, and within a tenth of it and back
  const TrackNoise noise{0.1, 0.5};
  const auto cost = [&](const std::vector<double>& t_s, const Eigen::Vector3d& errors) {
    return (whitener(noise, t_s) * errors).squaredNorm();
  };
  EXPECT_LT(cost({0, 0.5, 1}, {0, 0.5, 1}), 4.1);
  EXPECT_GT(cost({0, 0.1, 0.2}, {0, 1, 0}), 20);
}

}  // namespace
}  // namespace lintel
