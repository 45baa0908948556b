// SPDX-License-Identifier: BSD-3-Clause
#include "PointsTurn.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr double kFocal_px = 460;
const TwoViewParams kTwoViews{kFocal_px};

/// 100 points from 2 m on, over a `depth_m`, seen by a camera that turns by `rotation` (its new axes in the old ones)
/// and moves.
std::vector<TwoViewPair> pairsOf(const Eigen::Vector3d& rotation, const Eigen::Vector3d& p_c0_c1, double noise_px,
                                 double depth_m = 6) {
  std::vector<TwoViewPair> pairs;
  for (int i = 0; i < 100; ++i) {
    const double depth = 2 + depth_m * std::fmod(i * 0.618, 1.0);
    const Eigen::Vector3d p_c0(depth * (-0.7 + 0.014 * i), depth * (0.45 * std::sin(1.7 * i)), depth);
    const Eigen::Vector3d p_c1 = expRotation(rotation).conjugate() * (p_c0 - p_c0_c1);
    const Eigen::Vector2d noise = noise_px / kFocal_px * Eigen::Vector2d(std::sin(12.9898 * i), std::sin(78.233 * i));
    pairs.push_back({p_c0 / p_c0.z(), p_c1 / p_c1.z() + Eigen::Vector3d(noise.x(), noise.y(), 0)});
  }
  return pairs;
}

TEST(PointsTurn, FindsARotationWithoutTranslation) {
  const Eigen::Vector3d rotation(0.03, -0.05, 0.08);
  const auto turn = turnOfPoints(pairsOf(rotation, Eigen::Vector3d::Zero(), 0.2), kTwoViews);
  ASSERT_TRUE(turn);
  EXPECT_LT((turn->rotation - rotation).norm(), 2e-3) << turn->rotation.transpose();
}

TEST(PointsTurn, TranslationIsNoRotation) {
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.08, 0, 0), Eigen::Vector3d(0, 0.03, 0.08), Eigen::Vector3d(-0.03, 0.05, -0.05)}) {
    const Eigen::Vector3d rotation(0.01, 0.02, -0.03);
    const auto turn = turnOfPoints(pairsOf(rotation, p, 0.2), kTwoViews);
    ASSERT_TRUE(turn);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LT(std::abs(turn->rotation[axis] - rotation[axis]), 4 * turn->sigma[axis]) << p.transpose();
    EXPECT_LT(turn->sigma.maxCoeff(), 0.01);
  }
}

TEST(PointsTurn, ACameraThatMovesAlongAWallDoesNotTurn) {
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.05, 0, 0), Eigen::Vector3d(0, -0.06, 0.005)}) {
    const Eigen::Vector3d rotation(0.001, -0.002, 0.001);
    const auto turn = turnOfPoints(pairsOf(rotation, p, 0.2, 0.2), kTwoViews);
    ASSERT_TRUE(turn);
    EXPECT_LT((turn->rotation - rotation).norm(), 5e-3)
        << "translation looks like 25 mrad: " << turn->rotation.transpose();
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LT(std::abs(turn->rotation[axis] - rotation[axis]), 4 * turn->sigma[axis]) << axis;
  }
}

TEST(PointsTurn, NothingIsSaidOfFewOrUnrelatedPoints) {
  EXPECT_FALSE(turnOfPoints(std::vector<TwoViewPair>(14), kTwoViews));
  std::vector<TwoViewPair> pairs;
  pairs.reserve(60);
  for (int i = 0; i < 60; ++i)
    pairs.push_back(
        {{0.7 * std::sin(3.1 * i), 0.5 * std::sin(5.3 * i), 1}, {0.7 * std::sin(7.7 * i), 0.5 * std::sin(9.1 * i), 1}});
  EXPECT_FALSE(turnOfPoints(pairs, kTwoViews));
}

}  // namespace
}  // namespace lintel
