// SPDX-License-Identifier: BSD-3-Clause
#include "SigmaCheck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lintel {
namespace {

using ::testing::HasSubstr;

/// The `k`th pose of a walk of 0.1 m a step, known to `sigma_m`.
WindowUpdate poseAt(int k, double sigma_m, bool blind = false) {
  WindowUpdate update;
  update.status = EstimatorStatus::kTracking;
  update.T_w_b.p.x() = 0.1 * k;
  update.covariance.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * sigma_m * sigma_m / 3;
  update.blind = blind;
  return update;
}

TEST(SigmaCheck, ATenthOfTheWayIsAllowed) {
  SigmaCheck check;
  for (int k = 0; k <= 100; ++k) check.add(poseAt(k, 0.009 * k));
  EXPECT_EQ(check.fault(), "");
  EXPECT_NEAR(check.worst(), 0.9 / 1.1, 1e-9);
}

TEST(SigmaCheck, MoreIsAFaultThatSaysHowMuch) {
  SigmaCheck check;
  for (int k = 0; k <= 100; ++k) check.add(poseAt(k, 0.02 * k));
  EXPECT_THAT(check.fault(), HasSubstr("after a way of 10.0 m the position is unknown by 2.0 m"));
}

TEST(SigmaCheck, MoreIsAllowedWhereWhatIsSeenIsFarAway) {
  const auto faultAt = [](double distance_m) {
    SigmaCheck check;
    WindowUpdate start = poseAt(0, 0), soon = poseAt(5, 0.3);
    start.points_distance_m = soon.points_distance_m = distance_m;
    check.add(start);
    check.add(soon);
    return check.fault();
  };
  EXPECT_THAT(faultAt(5), HasSubstr("after a way of 0.5 m the position is unknown by 0.3 m"));
  EXPECT_EQ(faultAt(50), "");
}

TEST(SigmaCheck, WhatIsGainedInDarknessIsSaidElsewhere) {
  SigmaCheck check;
  for (int k = 0; k <= 100; ++k) check.add(poseAt(k, k < 50 ? 0.01 : 0.02 * k, k >= 50 && k < 100));
  EXPECT_EQ(check.fault(), "");
}

TEST(SigmaCheck, AnotherStartIsNoGain) {
  SigmaCheck check;
  check.add(poseAt(0, 0));
  WindowUpdate lost;
  lost.status = EstimatorStatus::kLost;
  check.add(lost);
  check.add(poseAt(1, 5));
  check.add(poseAt(2, 5));
  EXPECT_EQ(check.worst(), 0);
}

}  // namespace
}  // namespace lintel
