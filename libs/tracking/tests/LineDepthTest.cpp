// SPDX-License-Identifier: BSD-3-Clause
#include "LineDepth.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr double kFocal_px = 460;

ImageLine imageOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {kFocal_px * a.hnormalized(), kFocal_px * b.hnormalized()};
}

double acrossError(const ImageLine& line, const ImageLine& truth) {
  const Eigen::Vector2d n = truth.normal();
  return std::max(std::abs(n.dot(line.start - truth.start)), std::abs(n.dot(line.end - truth.start)));
}

/// Follows a slanted line past a moving camera; returns how far each step's expectation is off across the line.
std::vector<double> follow(int steps) {
  const Eigen::Quaterniond R_c1_c0 = expRotation(Eigen::Vector3d(0.01, -0.015, 0.02));
  Eigen::Vector3d a(-0.5, -1, 3), b(-0.2, 1, 4);
  LineDepth depth{{0.5, 0.25}, {0.5, 0.25}, 1};  // truly 1/3 and 1/4
  std::vector<double> errors;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector3d t_c1(-0.08 - 0.02 * (i % 3), 0.01, -0.03);
    const ImageLine line = imageOf(a, b), turned = imageOf(R_c1_c0 * a, R_c1_c0 * b);
    a = R_c1_c0 * a + t_c1;
    b = R_c1_c0 * b + t_c1;
    const ImageLine seen = imageOf(a, b);
    const CarriedDepth carried = carry(depth, line, turned, R_c1_c0, t_c1, kFocal_px);
    errors.push_back(acrossError(carried.line, seen));
    depth = observe(carried, turned, seen, t_c1, kFocal_px, 0.35);
  }
  return errors;
}

TEST(LineDepth, learnsFromMotionWhereALineMustGo) {
  const std::vector<double> errors = follow(8);
  EXPECT_GT(errors.front(), 2);  // the depth was assumed
  EXPECT_LT(errors.back(), 0.2);
}

TEST(LineDepth, isLinearAlongTheImage) {
  const Eigen::Vector3d a(-0.5, -1, 3), b(-0.2, 1, 4), middle = 0.7 * a + 0.3 * b;
  const LineDepth depth{{1 / a.z(), 1e-4}, {1 / b.z(), 1e-4}, 3};
  const LineDepth part = alongLine(depth, imageOf(a, b), imageOf(middle, b));
  EXPECT_NEAR(part.start.w, 1 / middle.z(), 1e-9);
  EXPECT_NEAR(part.end.w, 1 / b.z(), 1e-9);
  EXPECT_EQ(part.epoch, 3);
  const LineDepth longer = alongLine(depth, imageOf(a, b), imageOf(a, b + 0.5 * (b - a)));
  EXPECT_GT(longer.end.variance, depth.end.variance);  // beyond what has been seen
}

TEST(LineDepth, isUnknownWithoutTranslation) {
  const Eigen::Vector3d a(-0.5, -1, 3), b(-0.2, 1, 4);
  const LineDepth depth{{0.5, 0.25}, {0.5, 0.25}, 1};
  const ImageLine line = imageOf(a, b);
  const Eigen::Vector3d rest = Eigen::Vector3d::Zero();
  const CarriedDepth carried = carry(depth, line, line, Eigen::Quaterniond::Identity(), rest, kFocal_px);
  EXPECT_LT(acrossError(carried.line, line), 1e-9);
  const LineDepth after = observe(carried, line, line, rest, kFocal_px, 0.35);
  EXPECT_NEAR(after.start.w, 0.5, 1e-9);
  EXPECT_GE(after.start.variance, 0.25);
}

}  // namespace
}  // namespace lintel
