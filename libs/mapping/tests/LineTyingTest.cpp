// SPDX-License-Identifier: BSD-3-Clause
#include "LineTying.h"

#include <gtest/gtest.h>

#include "LineJudgement.h"
#include "PointsOnLines.h"
#include "TestMaterial.h"

namespace lintel {
namespace {

using namespace test;

/// Keyframes fly along x: what lies along x shows neither its direction in the plane of the flight nor its depth.
class LineTyingTest : public testing::Test {
 protected:
  LineTyingTest() { params_.max_sigma_m = params_.max_relative_sigma = 0.1; }

  /// The only line of the material, fitted with the group's direction.
  LineRecord tied(LineRecord line, const Eigen::Vector3d& direction_w) {
    line.parallel = true;
    fitLine(cameras_, fit_, line);
    MapGroup group;
    group.direction_w = direction_w.normalized();
    group.spread_rad = 0.01;
    material_.lines = {line};
    tied_ = tieDegenerateLines(cameras_, fit_, params_, {group}, material_);
    return material_.lines[0];
  }
  LineRecord railing() const { return lineOf(material_, 1, rail_); }
  PointRecord pointAt(TrackId id, const Eigen::Vector3d& p_w) const {
    PointRecord point = pointOf(material_, id, p_w);
    point.known = true;
    point.p_w = p_w;
    point.sigma_distance_m = 0.02;
    return point;
  }
  LineState stateOf(const LineRecord& line) const { return judgeMapLine(params_, cameras_, line).state; }

  MapMaterial material_ = materialAlongX();
  KeyframeCameras cameras_{material_};
  LineFitParams fit_;
  MapParams params_;
  int tied_ = 0;
  const Segment3 rail_{{0, 0.5, 4}, {2, 0.5, 4}}, slant_{{0, 0.5, 4}, {2, 0.9, 4.6}},
      nearly_{{0, 0.5, 4}, {2, 0.56, 4}};
};

TEST_F(LineTyingTest, ALineNearlyAlongTheFlightTakesItsGroupsDirection) {
  params_.max_sigma_m = params_.max_relative_sigma = 0.3;
  LineRecord free = lineOf(material_, 1, nearly_);
  ASSERT_TRUE(fitLine(cameras_, fit_, free));
  ASSERT_EQ(stateOf(free), LineState::kDegenerate);
  const LineRecord line = tied(lineOf(material_, 1, nearly_), nearly_.direction());
  ASSERT_EQ(tied_, 1);
  EXPECT_LT(lineAngle(line.estimate.direction_w, nearly_.direction()), 1e-6);
  EXPECT_LT(line.estimate.sigmaDirection(), 0.0101) << "that of the group";
  EXPECT_GT(free.estimate.sigmaDirection(), 0.05);
}

TEST_F(LineTyingTest, WhereNothingShowsTheDepthItStaysOpen) {
  const LineRecord line = tied(railing(), {1, 0, 0});
  EXPECT_NE(stateOf(line), LineState::kKnown) << "a direction is no place";
}

TEST_F(LineTyingTest, PointsOnItGiveItsDepth) {
  material_.points = {pointAt(1, {0.7, 0.5, 4}), pointAt(2, {1.6, 0.5, 4})};
  const LineRecord line = tied(railing(), {1, 0, 0});
  ASSERT_EQ(tied_, 1);
  EXPECT_EQ(line.tie->points.size(), 2u);
  EXPECT_LT((line.estimate.middle_w - rail_.start).cross(rail_.direction()).norm(), 0.01);
  EXPECT_EQ(stateOf(line), LineState::kKnown);
  EXPECT_LT(line.estimate.sigmaPosition(0), 0.03);
}

TEST_F(LineTyingTest, APointBesideTheLineDoesNotCount) {
  material_.points = {pointAt(1, {0.7, 0.53, 4}), pointAt(2, {2.4, 0.5, 4})};  // three pixels across; beyond the end
  EXPECT_TRUE(PointsOnLines(cameras_, material_.points).on(railing(), {1, 0, 0}).empty());
}

TEST_F(LineTyingTest, OfPointsAtDifferentDepthsTheMostThatAgreeCount) {
  // in the plane of flight and line, where whatever is seen on the line stays on it
  const auto inPlane = [&](double x, double depth) { return Eigen::Vector3d(x, 0.5 / 4 * depth, depth); };
  material_.points = {pointAt(1, inPlane(0.7, 4)), pointAt(2, inPlane(1.2, 5)), pointAt(3, inPlane(1.6, 4))};
  const LineRecord line = tied(railing(), {1, 0, 0});
  ASSERT_EQ(tied_, 1);
  EXPECT_EQ(line.tie->points.size(), 2u);
  EXPECT_LT((line.estimate.middle_w - rail_.start).cross(rail_.direction()).norm(), 0.02);
}

TEST_F(LineTyingTest, ALineThatIsNotParallelIsNotBent) {
  // degenerate by the gate, but its views show that it is none of the group
  params_.max_sigma_direction_rad = 1e-6;
  const LineRecord free = [&] {
    LineRecord line = lineOf(material_, 1, slant_);
    fitLine(cameras_, fit_, line);
    return line;
  }();
  const LineRecord line = tied(lineOf(material_, 1, slant_), {1, 0, 0});
  EXPECT_EQ(tied_, 0);
  EXPECT_FALSE(line.tie);
  EXPECT_EQ(line.estimate.direction_w, free.estimate.direction_w);
}

TEST_F(LineTyingTest, WhatTheWindowDidNotFindParallelIsNotConstrained) {
  LineRecord line = lineOf(material_, 1, nearly_);
  ASSERT_TRUE(fitLine(cameras_, fit_, line));
  MapGroup group;
  group.direction_w = nearly_.direction();
  for (const bool parallel : {false, true}) {
    line.parallel = parallel;
    material_.lines = {line};
    EXPECT_EQ(tieDegenerateLines(cameras_, fit_, params_, {group}, material_), parallel);
  }
}

TEST_F(LineTyingTest, AWellDeterminedLineIsNotConstrained) {
  const Segment3 upright{{0.8, -0.7, 4}, {0.9, 0.6, 4.1}};
  const LineRecord line = tied(lineOf(material_, 1, upright), upright.direction());
  EXPECT_EQ(tied_, 0);
  EXPECT_FALSE(line.tie);
  params_.max_sigma_direction_rad = 1e-6;  // now it would not
  tied(lineOf(material_, 1, upright), upright.direction());
  EXPECT_EQ(tied_, 1);
}

/// A known line whose views are off by a noise that turns it.
class AlignToGroups : public LineTyingTest {
 protected:
  LineRecord aligned(const Segment3& segment, const Eigen::Vector3d& direction_w) {
    LineRecord line = lineOf(material_, 1, segment);
    for (LineView& view : line.views) view.end_px += Eigen::Vector2f(0.5F, 0);
    EXPECT_TRUE(fitLine(cameras_, fit_, line));
    EXPECT_EQ(stateOf(line), LineState::kKnown);
    MapGroup group;
    group.direction_w = direction_w.normalized();
    material_.lines = {line};
    free_ = line;
    aligned_ = alignToGroups(cameras_, fit_, params_, {group}, material_);
    return material_.lines[0];
  }

  LineRecord free_;
  int aligned_ = 0;
  const Segment3 upright_{{0.8, -0.3, 4}, {0.83, 0.3, 4.05}};
};

TEST_F(AlignToGroups, ALineThatMayBeParallelTakesTheDirectionWithItsWeight) {
  const LineRecord line = aligned(upright_, upright_.direction());
  ASSERT_EQ(aligned_, 1);
  EXPECT_LT(lineAngle(line.estimate.direction_w, upright_.direction()),
            0.7 * lineAngle(free_.estimate.direction_w, upright_.direction()));
  EXPECT_LE(line.estimate.sigmaDirection(), 0.0051) << "that of the group";
  EXPECT_FALSE(line.tie) << "it is known without";
}

TEST_F(AlignToGroups, ALineThatIsNotParallelStays) {
  const LineRecord line = aligned(upright_, {0.2, 1, 0.1});
  EXPECT_EQ(aligned_, 0);
  EXPECT_EQ(line.estimate.direction_w, free_.estimate.direction_w);
}

}  // namespace
}  // namespace lintel
