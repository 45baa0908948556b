// SPDX-License-Identifier: BSD-3-Clause
#include "window/ScaleDrift.h"

#include <gtest/gtest.h>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

SlidingWindow pathOf(double scale) {
  return windowAt({at(0, 0, 0), at(scale, 0, 0), at(scale, 2 * scale, 0), at(0, 0, 0)});
}

/// After solves that change the scale in steps.
ScaleDrift driftOf(double sigma, const std::vector<double>& scales) {
  ScaleDrift drift;
  drift.start(sigma);
  for (std::size_t i = 1; i < scales.size(); ++i) {
    drift.beforeSolve(pathOf(scales[i - 1]));
    drift.afterSolve(pathOf(scales[i]));
  }
  return drift;
}

TEST(ScaleDrift, ChangesAddUp) {
  EXPECT_FALSE(driftOf(0.015, {1, 1.05, 1.085}).leftStart()) << "5.4 sigma";
  EXPECT_TRUE(driftOf(0.015, {1, 1.05, 1.1}).leftStart()) << "6.4 sigma";
  EXPECT_TRUE(driftOf(0.015, {1, 0.95, 0.91}).leftStart());
  EXPECT_FALSE(driftOf(0.015, {1, 1.1, 1}).leftStart()) << "and cancel";
}

TEST(ScaleDrift, ATenthPaysANewStartUnlessTheStartWasThatUncertain) {
  EXPECT_FALSE(driftOf(0.03, {1, 1.1}).leftStart());
  EXPECT_TRUE(driftOf(0.03, {1, 1.11}).leftStart()) << "3.5 sigma";
  EXPECT_FALSE(driftOf(0.08, {1, 1.16}).leftStart()) << "1.9 sigma";
  EXPECT_TRUE(driftOf(0.08, {1, 1.18}).leftStart()) << "2.1 sigma";
}

TEST(ScaleDrift, AFewPerCentDoNotPayANewStart) {
  EXPECT_FALSE(driftOf(0.001, {1, 1.05}).leftStart());
  EXPECT_TRUE(driftOf(0.001, {1, 1.06}).leftStart());
}

TEST(ScaleDrift, AStartWithoutScaleIsNotLeft) {
  EXPECT_FALSE(driftOf(std::numeric_limits<double>::infinity(), {1, 5}).leftStart());
}

TEST(ScaleDrift, AVehicleAtRestHasNoScale) { EXPECT_FALSE(driftOf(0.02, {0, 1, 0}).leftStart()); }

TEST(ScaleDrift, AChangeThatNoSigmaExplainsIsToldOnce) {
  ScaleDrift drift = driftOf(0.01, {1, 1.01, 1.02});
  EXPECT_EQ(drift.takeUnexplainedChange(0.01), 0) << "2 sigma";
  drift.beforeSolve(pathOf(1.02));
  drift.afterSolve(pathOf(1.03));
  EXPECT_EQ(drift.takeUnexplainedChange(0.02), 0) << "1.5 of the present sigma";
  EXPECT_NEAR(drift.takeUnexplainedChange(0.01), std::log(1.03), 1e-12) << "3 sigma";
  EXPECT_EQ(drift.takeUnexplainedChange(0.01), 0);
  drift.beforeSolve(pathOf(1.03));
  drift.afterSolve(pathOf(1.09));
  EXPECT_EQ(drift.takeUnexplainedChange(0.01), 0) << "1.8 of the enlarged sigma";
}

TEST(ScaleDrift, ASlowChangeIsExplainedByTheSigmasThatAreSaidMeanwhile) {
  ScaleDrift drift;
  drift.start(0.01);
  for (int i = 0; i < 300; ++i) {
    drift.beforeSolve(pathOf(std::pow(1.0005, i)));
    drift.afterSolve(pathOf(std::pow(1.0005, i + 1)));
    EXPECT_EQ(drift.takeUnexplainedChange(0.01), 0) << i;
  }
}

TEST(ScaleDrift, TurningAndMovingIsNoChange) {
  ScaleDrift drift;
  drift.start(0.001);
  SlidingWindow window = pathOf(1);
  drift.beforeSolve(window);
  const Pose T{Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ())), {5, 3, 1}};
  for (WindowFrame& frame : window.frames) frame.pose = toBlock(T * frame.T_w_b());
  drift.afterSolve(window);
  EXPECT_FALSE(drift.leftStart());
}

}  // namespace
}  // namespace lintel
