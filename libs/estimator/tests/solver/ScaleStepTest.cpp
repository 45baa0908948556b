// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ScaleStep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "solver/Factor.h"
#include "solver/WindowSolver.h"

namespace lintel {
namespace {

using namespace test;

const Eigen::Vector3d kCentre(1, -2, 0.5), kOrigin(3, 1, 1);

PointBlock pointAt(const Eigen::Vector3d& p_w) {
  PointBlock block;
  block << p_w - kOrigin, 1;
  return block.normalized();
}

Eigen::Vector3d positionOf(const PointBlock& block) { return kOrigin + block.head<3>() / block[3]; }

LineBlock lineOf(const Segment3& s) { return toBlock(toOrthonormal(lineThrough(s.start - kOrigin, s.end - kOrigin))); }

double distanceTo(const LineBlock& block, const Eigen::Vector3d& p_w) {
  const PluckerLine line = lineFromBlock(block.data()).plucker();
  return (line.n - (p_w - kOrigin).cross(line.d)).norm() / line.d.norm();
}

Eigen::Vector3d scaled(const Eigen::Vector3d& p_w, double change) { return kCentre + (1 + change) * (p_w - kCentre); }

/// What a linear solution makes of a change of scale: the tangent of the blocks that scaling passes through.
template <class Block, int kTangent>
Eigen::Matrix<double, kTangent, 1> linearStep(BlockKey::Kind kind, const Block& little_larger, const Block& block,
                                              double little, double change) {
  Eigen::Matrix<double, kTangent, 1> rate;
  manifoldOf(kind)->Minus(little_larger.data(), block.data(), rate.data());
  return rate / little * change;
}

TEST(ScaleStep, APointIsWhereTheScaleTakesIt) {
  constexpr double kLittle = 1e-6;
  const Eigen::Vector3d p_w(12, 30, 80);
  for (const double change : {-0.3, 0.1, 0.8}) {
    const PointBlock block = pointAt(p_w);
    const auto step =
        linearStep<PointBlock, kPointTangent>(BlockKey::kPoint, pointAt(scaled(p_w, kLittle)), block, kLittle, change);
    PointBlock moved, linear;
    ScaleStep(kCentre, change).plus(BlockKey::kPoint, kOrigin, block.data(), step.data(), moved.data());
    manifoldOf(BlockKey::kPoint)->Plus(block.data(), step.data(), linear.data());
    EXPECT_LT((positionOf(moved) - scaled(p_w, change)).norm(), 1e-3) << change;
    EXPECT_GT((positionOf(linear) - scaled(p_w, change)).norm(), 0.5) << "else nobody needs this: " << change;
  }
}

TEST(ScaleStep, ALineIsWhereTheScaleTakesIt) {
  constexpr double kLittle = 1e-6;
  const Segment3 s{{12, 30, 80}, {-5, 33, 70}};
  for (const double change : {-0.3, 0.1, 0.8}) {
    const LineBlock larger = lineOf({scaled(s.start, kLittle), scaled(s.end, kLittle)});
    const LineBlock block = lineOf(s);
    const auto step = linearStep<LineBlock, kLineTangent>(BlockKey::kLine, larger, block, kLittle, change);
    LineBlock moved, linear;
    ScaleStep(kCentre, change).plus(BlockKey::kLine, kOrigin, block.data(), step.data(), moved.data());
    manifoldOf(BlockKey::kLine)->Plus(block.data(), step.data(), linear.data());
    for (const Eigen::Vector3d& end : {s.start, s.end}) {
      EXPECT_LT(distanceTo(moved, scaled(end, change)), 1e-3) << change;
      EXPECT_GT(distanceTo(linear, scaled(end, change)), 0.2) << "else nobody needs this: " << change;
    }
  }
}

TEST(ScaleStep, SmallStepsAreThoseOfTheManifold) {
  constexpr double kChange = 1e-4;
  const PointBlock point = pointAt({4, 3, 9});
  const LineBlock line = lineOf({{4, 3, 9}, {2, 3, 7}});
  const Eigen::Vector3d point_step(2e-4, -1e-4, 3e-4);
  const Eigen::Vector4d line_step(2e-4, -1e-4, 3e-4, 1e-4);
  PointBlock point_moved, point_linear;
  LineBlock line_moved, line_linear;
  const ScaleStep scale(kCentre, kChange);
  scale.plus(BlockKey::kPoint, kOrigin, point.data(), point_step.data(), point_moved.data());
  scale.plus(BlockKey::kLine, kOrigin, line.data(), line_step.data(), line_moved.data());
  manifoldOf(BlockKey::kPoint)->Plus(point.data(), point_step.data(), point_linear.data());
  manifoldOf(BlockKey::kLine)->Plus(line.data(), line_step.data(), line_linear.data());
  Eigen::Vector3d point_difference;
  Eigen::Vector4d line_difference;
  manifoldOf(BlockKey::kPoint)->Minus(point_moved.data(), point_linear.data(), point_difference.data());
  manifoldOf(BlockKey::kLine)->Minus(line_moved.data(), line_linear.data(), line_difference.data());
  EXPECT_LT(point_difference.norm(), 3e-7) << "of second order";
  EXPECT_LT(line_difference.norm(), 3e-7);
}

TEST(ScaleStep, DistancesFromACentre) {
  const PointBlock point = pointAt(kCentre + Eigen::Vector3d(0, 3, 4));
  EXPECT_NEAR(landmarkDistance(BlockKey::kPoint, kOrigin - kCentre, point.data()), 5, 1e-9);
  const LineBlock line = lineOf({kCentre + Eigen::Vector3d(-7, 0, 2), kCentre + Eigen::Vector3d(3, 0, 2)});
  EXPECT_NEAR(landmarkDistance(BlockKey::kLine, kOrigin - kCentre, line.data()), 2, 1e-9);
  const PointBlock far(0.6, 0, 0.8, 0);
  EXPECT_GT(landmarkDistance(BlockKey::kPoint, kOrigin, far.data()), 1e9);
}

TEST(ScaleStep, ALineThroughItsOriginAndAnAbsurdChangeStayFinite) {
  const LineBlock line = lineOf({kOrigin, kOrigin + Eigen::Vector3d(0, 1, 2)});
  const Eigen::Vector4d step(0.1, 0, 0, -0.1);
  for (const double change : {-3.0, 0.1, std::numeric_limits<double>::max()}) {
    LineBlock moved;
    ScaleStep(kCentre, change).plus(BlockKey::kLine, kOrigin, line.data(), step.data(), moved.data());
    EXPECT_TRUE(moved.allFinite());
  }
  EXPECT_LE(ScaleStep(kCentre, 5).change(), 1);
  EXPECT_GE(ScaleStep(kCentre, -5).change(), -0.5) << "no scale becomes negative";
}

}  // namespace
}  // namespace lintel
