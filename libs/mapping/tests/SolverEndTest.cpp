// SPDX-License-Identifier: BSD-3-Clause
#include "SolverEnd.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

constexpr double kLeastGain = 10;

class SolverEndTest : public ::testing::Test {
 protected:
  /// Whether it ends after an iteration that lowers the cost by `gain` and leaves the way with a scale.
  bool ends(double gain, double scale, bool successful = true) {
    way_w_ = scale * kWay_w;
    ceres::IterationSummary summary;
    summary.iteration = iteration_++;
    summary.cost_change = gain;
    summary.step_is_successful = successful;
    return end_(summary) != ceres::SOLVER_CONTINUE;
  }

  const Eigen::Matrix3Xd kWay_w = (Eigen::Matrix3Xd(3, 2) << 1, 0, 0, 2, 0.5, 0).finished();
  Eigen::Matrix3Xd way_w_;
  bool go_on_ = true;
  int iteration_ = 0;
  SolverEnd end_{kLeastGain, [this] { return way_w_; }, [this](int) { return go_on_; }};
};

TEST_F(SolverEndTest, ASmallGainEndsIt) {
  EXPECT_FALSE(ends(0, 1)) << "the first call is before any iteration";
  EXPECT_FALSE(ends(1000, 1.0005));
  EXPECT_TRUE(ends(5, 1.0004));
}

TEST_F(SolverEndTest, AScaleThatGoesOnDoesNot) {
  ends(0, 1);
  EXPECT_FALSE(ends(5, 1.02));
  EXPECT_FALSE(ends(2, 1.03)) << "a hundredth more";
  EXPECT_FALSE(ends(1, 1.02)) << "and back";
  EXPECT_TRUE(ends(1, 1.0205));
}

TEST_F(SolverEndTest, AStepThatWasRefusedOrRaisesTheCostDoesNotEndIt) {
  ends(0, 1);
  EXPECT_FALSE(ends(-3, 1));
  EXPECT_FALSE(ends(5, 1, false));
  EXPECT_TRUE(ends(5, 1));
}

TEST_F(SolverEndTest, WithoutAWayTheGainDecides) {
  ends(0, 0);
  EXPECT_FALSE(ends(50, 0));
  EXPECT_TRUE(ends(5, 0));
}

TEST_F(SolverEndTest, WhoeverWaitsMayEndIt) {
  ends(0, 1);
  go_on_ = false;
  EXPECT_TRUE(ends(1000, 1.5));
}

}  // namespace
}  // namespace lintel
