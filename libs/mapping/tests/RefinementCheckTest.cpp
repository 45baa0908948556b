// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "DriftedFlight.h"

namespace lintel {
namespace {

class RefinementCheckTest : public test::DriftedFlight {};

TEST_F(RefinementCheckTest, IsRefusedWherePointsLeftOutFitWorse) {
  slideAllButHeldOut(params_, material_);
  const double before = error(material_);
  const RefinementReport report = refine(material_);
  EXPECT_GE(report.held_out, 5u);
  EXPECT_GT(report.held_out_growth, 2);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("points left out of it fit worse"), std::string::npos) << report.verdict;
  EXPECT_EQ(error(material_), before) << "the poses stay";
}

TEST_F(RefinementCheckTest, TwoPointsLeftOutDoNotDecide) {
  int held_out = 0;
  for (PointRecord& point : material_.points)
    if (point.id % 20 == 1 && point.views.size() > 3 && ++held_out > 2) point.id += 1'000'001;  // held out no more
  std::sort(material_.points.begin(), material_.points.end(),
            [](const PointRecord& a, const PointRecord& b) { return a.id < b.id; });
  slideAllButHeldOut(params_, material_);
  const RefinementReport report = refine(material_);
  EXPECT_EQ(report.held_out, 2u);
  EXPECT_GT(report.held_out_after_px, 1.02 * report.held_out_before_px + 0.01);
  EXPECT_TRUE(report.accepted) << report.verdict;
}

TEST_F(RefinementCheckTest, ACancelledRefinementLeavesPosesAndEstimatesLandmarks) {
  for (const double when : {0.0, 0.25, 0.7}) {  // at the start, within a round, when lines are merged
    MapMaterial refused = material_, prepared = material_;
    std::vector<double> told;
    const RefinementReport report = BatchRefinement(rig_, estimator_, {}, params_).refine(refused, [&](double done) {
      told.push_back(done);
      return done < when;
    });
    EXPECT_FALSE(report.accepted);
    EXPECT_EQ(report.verdict, "not refined: the run was cancelled");
    ASSERT_GE(told.size(), 2u);
    EXPECT_EQ(told.back(), 1);
    EXPECT_LT(told[told.size() - 2], when + 0.2) << "it went on";
    prepareMaterial({}, prepared);
    EXPECT_EQ(error(refused), error(prepared));
    const LineMap map = drawMap({}, refused), expected = drawMap({}, prepared);
    ASSERT_EQ(map.lines.size(), expected.lines.size());
    ASSERT_FALSE(map.lines.empty());
    for (std::size_t i = 0; i < map.lines.size(); ++i)
      EXPECT_EQ(map.lines[i].segment_w.start, expected.lines[i].segment_w.start);
  }
}

TEST_F(RefinementCheckTest, WhatTheImuContradictsIsNotUsed) {
  for (RetiredKeyframe& keyframe : material_.keyframes) {
    if (!keyframe.imu) continue;
    ImuBatch wrong = keyframe.imu->samples();
    for (std::size_t i = 0; i < wrong.size(); ++i) wrong[i].accel *= i % 2 ? 1.6 : 0.3;
    for (ImuSample& s : wrong) s.gyro.x() += s.t_ns % 2'000'000'000 < 1'000'000'000 ? 0.3 : -0.3;
    auto imu = std::make_shared<Preintegration>(ImuBias{}, rig_.imu_noise);
    imu->append(wrong);
    keyframe.imu = imu;
  }
  const std::vector<RetiredKeyframe> before = material_.keyframes;
  const RefinementReport report = refine(material_);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("not refined"), std::string::npos);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(material_.keyframes[i].T_w_b.p, before[i].T_w_b.p);
  EXPECT_TRUE(std::any_of(material_.lines.begin(), material_.lines.end(), [](const LineRecord& l) { return l.known; }))
      << "the map is made with the poses as they were";
}

TEST_F(RefinementCheckTest, AChangeThatIsTooLargeIsNotUsed) {
  params_.max_moved_m = params_.max_moved_share = 0;
  const RefinementReport report = refine(material_);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("moved"), std::string::npos) << report.verdict;
}

TEST_F(RefinementCheckTest, AfterAStartThatFailsItIsTriedFromWhereThePosesWere) {
  MapMaterial elsewhere = material_, as_it_was = material_;
  const auto tearApart = [](MapMaterial& start) {  // the adjustment cannot mend it
    for (RetiredKeyframe& keyframe : start.keyframes) keyframe.T_w_b.p.x() += keyframe.id % 2 ? 1e6 : -1e6;
  };
  const BatchRefinement refinement(rig_, estimator_, map_, params_);
  const RefinementReport report = refinement.refine(elsewhere, {}, {}, tearApart);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_TRUE(report.joins_refused);
  EXPECT_FALSE(refinement.refine(as_it_was).joins_refused);
  EXPECT_EQ(error(elsewhere), error(as_it_was));
}

TEST_F(RefinementCheckTest, WhereNothingWasSeenKeyframesMayMoveFarther) {
  params_.max_moved_m = params_.max_moved_share = 0;
  for (std::size_t k = 2; k + 2 < material_.keyframes.size(); ++k) material_.keyframes[k].blind = true;
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
}

TEST_F(RefinementCheckTest, AnAbsurdScaleIsRefusedByName) {
  for (const double scale : {0.0, -1.0, 1e9, std::nan("")}) {
    params_.sigma_scale = scale;
    EXPECT_THROW(refine(material_), std::invalid_argument) << scale;
  }
}

TEST_F(RefinementCheckTest, TooLittleToRefineSaysSo) {
  MapMaterial empty;
  empty.rig = rig_;
  const RefinementReport report = refine(empty);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("keyframes"), std::string::npos);
}

}  // namespace
}  // namespace lintel
