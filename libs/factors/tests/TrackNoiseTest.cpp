// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/TrackNoise.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

namespace lintel {
namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

ByRows whitened(const NoiseKind& kind, const std::vector<double>& t_s, ByRows errors) {
  Whitener(kind, t_s).whiten(errors.data(), static_cast<int>(errors.cols()));
  return errors;
}

/// L^-1 itself.
Eigen::MatrixXd whitener(const NoiseKind& kind, const std::vector<double>& t_s) {
  const auto n = static_cast<Eigen::Index>(t_s.size());
  return whitened(kind, t_s, ByRows::Identity(n, n));
}

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
  const NoiseKind noise{0.3, 0.8};
  const std::vector<double> t_s = {0.2, 0.3, 0.7, 1.9, 2.0};
  Eigen::MatrixXd covariance(5, 5);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      covariance(i, j) = (i == j ? 0.09 : 0) + 0.64 * (t_s[static_cast<std::size_t>(std::min(i, j))] - 0.2);
  const Eigen::MatrixXd W = whitener(noise, t_s);
  EXPECT_TRUE((W * covariance * W.transpose()).isIdentity(1e-12));
  EXPECT_TRUE(W.isLowerTriangular());
  EXPECT_NEAR(Whitener(noise, t_s).logDeterminant(), 0.5 * std::log(covariance.determinant()), 1e-12);
}

TEST(TrackNoise, PassesOverRowsAreProductsWithTheMatrix) {
  const NoiseKind noise{0.3, 0.8};
  const std::vector<double> t_s = {0.2, 0.3, 0.7, 1.9, 2.0};
  const Eigen::MatrixXd W = whitener(noise, t_s);
  for (const int columns : {1, 2, 5, 8, 24}) {
    const ByRows rows = ByRows::Random(5, columns);
    EXPECT_TRUE(whitened(noise, t_s, rows).isApprox(W * rows, 1e-12)) << columns;
    ByRows transposed = rows;
    Whitener(noise, t_s).whitenTransposed(transposed.data(), columns);
    EXPECT_TRUE(transposed.isApprox(W.transpose() * rows, 1e-12)) << columns;
  }
  const Eigen::VectorXd weights = Eigen::VectorXd::Random(5).cwiseAbs();
  std::vector<double> information;
  Whitener(noise, t_s).information(weights.data(), information);
  ASSERT_EQ(information.size(), 25u);
  EXPECT_TRUE(ByRows::Map(information.data(), 5, 5).isApprox(W.transpose() * weights.asDiagonal() * W, 1e-12));
}

TEST(TrackNoise, KindsDifferByTheirWalk) {
  const auto kinds = kindsAbout({0.1, 0.8});
  ASSERT_EQ(kinds.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(kinds[i].white, 0.1);
    EXPECT_EQ(kinds[i].walk, 0.2 * std::pow(4, i));
  }
  EXPECT_EQ(kindsAbout({0.4, 0}).size(), 1u) << "white noise";
}

TEST(TrackNoise, TheKindIsFoundInATracksErrors) {
  const auto kinds = kindsAbout({0.15, 0.3});
  const std::vector<double> t_s = {0, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.2, 1.6, 2};
  std::mt19937 random(1);
  std::normal_distribution<double> unit;
  constexpr int kTracks = 100;
  for (std::size_t truth = 0; truth < kinds.size(); ++truth) {
    int found = 0;
    for (int track = 0; track < kTracks; ++track) {
      Eigen::MatrixXd errors(10, 2);
      Eigen::RowVector2d walk = Eigen::RowVector2d::Zero();
      for (std::size_t i = 0; i < t_s.size(); ++i) {
        const double step = i == 0 ? 0 : kinds[truth].walk * std::sqrt(t_s[i] - t_s[i - 1]);
        walk += step * Eigen::RowVector2d(unit(random), unit(random));
        errors.row(static_cast<Eigen::Index>(i)) =
            walk + kinds[truth].white * Eigen::RowVector2d(unit(random), unit(random));
      }
      std::vector<double> costs;
      costs.reserve(kinds.size());
      for (const NoiseKind& kind : kinds) {
        costs.push_back(0.5 * whitened(kind, t_s, errors).squaredNorm() + 2 * Whitener(kind, t_s).logDeterminant());
      }
      found += std::min_element(costs.begin(), costs.end()) - costs.begin() == static_cast<std::ptrdiff_t>(truth);
    }
    EXPECT_GE(found, 80 * kTracks / 100) << truth;
  }
}

TEST(TrackNoise, ASlideIsForgivenAndAJumpIsNot) {
  // the same step of one pixel: over a second, and within a tenth of it and back
  const NoiseKind noise{0.1, 0.5};
  const auto cost = [&](const std::vector<double>& t_s, const Eigen::Vector3d& errors) {
    return (whitener(noise, t_s) * errors).squaredNorm();
  };
  EXPECT_LT(cost({0, 0.5, 1}, {0, 0.5, 1}), 4.1);
  EXPECT_GT(cost({0, 0.1, 0.2}, {0, 1, 0}), 20);
}

}  // namespace
}  // namespace lintel
