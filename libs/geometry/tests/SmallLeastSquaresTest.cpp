// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/SmallLeastSquares.h"

#include <gtest/gtest.h>

#include <limits>

namespace lintel {
namespace {

/// Two Rosenbrock valleys, r = (10 (y - x^2), 1 - x), in the pairs (0, 1) and (2, 3) of the state.
NormalEquations4 valleys(const Eigen::Vector4d& state) {
  NormalEquations4 normal;
  for (int k = 0; k < 4; k += 2) {
    const double x = state[k], y = state[k + 1];
    const Eigen::Vector2d r(10 * (y - x * x), 1 - x);
    Eigen::Matrix<double, 2, 4> J = Eigen::Matrix<double, 2, 4>::Zero();
    J.col(k) << -20 * x, -1;
    J(0, k + 1) = 10;
    normal.add(J, r);
    normal.cost += 0.5 * r.squaredNorm();
  }
  return normal;
}

Eigen::Vector4d sum(const Eigen::Vector4d& state, const Eigen::Vector4d& step) { return state + step; }

LevenbergParams patient() {
  LevenbergParams params;
  params.max_iterations = 200;
  params.min_relative_decrease = 0;
  return params;
}

TEST(SmallLeastSquares, FindsTheBottomOfBentValleys) {
  Eigen::Vector4d state(-1.2, 1, 2, -3);
  const NormalEquations4 end = levenbergMarquardt(patient(), state, valleys, sum);
  EXPECT_LT((state - Eigen::Vector4d::Ones()).norm(), 1e-6);
  EXPECT_LT(end.cost, 1e-12);
  EXPECT_EQ(end.H, valleys(state).H) << "the normal equations at the end";
}

TEST(SmallLeastSquares, NeverEntersWhatIsNotAllowed) {
  const auto fenced = [](const Eigen::Vector4d& state) {
    NormalEquations4 normal = valleys(state);
    if (state[0] > 0.5) normal.cost = std::numeric_limits<double>::infinity();
    return normal;
  };
  Eigen::Vector4d state(-1.2, 1, 1, 1);
  EXPECT_LT(levenbergMarquardt(patient(), state, fenced, sum).cost, valleys({-1.2, 1, 1, 1}).cost);
  EXPECT_LE(state[0], 0.5);
  Eigen::Vector4d outside(1, 1, 1, 1);
  EXPECT_FALSE(std::isfinite(levenbergMarquardt(patient(), outside, fenced, sum).cost));
  EXPECT_EQ(outside, Eigen::Vector4d::Ones()) << "a start that is not allowed stays where it is";
}

TEST(SmallLeastSquares, WhatIsNotObservedHasALargeSigma) {
  const Eigen::Vector4d information(4, 100, 0, 25);
  const Eigen::Matrix4d covariance = covarianceOf(information.asDiagonal());
  EXPECT_NEAR(covariance(0, 0), 0.25, 1e-12);
  EXPECT_NEAR(covariance(2, 2), 1e6, 1e-3);
}

TEST(SmallLeastSquares, TheWorstSigmaIsThatOfTheLongestAxis) {
  const double turn = 0.3;
  Eigen::Matrix2d R;
  R << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  EXPECT_NEAR(worstSigma(R * Eigen::Vector2d(9, 4).asDiagonal() * R.transpose()), 3, 1e-12);
  EXPECT_EQ(worstSigma(Eigen::Matrix2d::Zero()), 0);
}

}  // namespace
}  // namespace lintel
