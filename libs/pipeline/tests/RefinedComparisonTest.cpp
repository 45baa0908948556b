// SPDX-License-Identifier: BSD-3-Clause
#include "../src/RefinedComparison.h"

#include <gmock/gmock.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using testing::HasSubstr;

/// A circle of radius 1 m, 2 * pi m long, at 20 Hz for 10 s.
std::vector<OdometryPose> circle(double scale = 1) {
  std::vector<OdometryPose> poses;
  for (int i = 0; i <= 200; ++i) {
    OdometryPose pose;
    pose.t_ns = i * 50'000'000LL;
    const double angle = 2 * EIGEN_PI * i / 200;
    pose.T_w_b.p = scale * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    poses.push_back(pose);
  }
  return poses;
}

std::vector<OdometryPose> moved(std::vector<OdometryPose> poses, const Pose& T) {
  for (OdometryPose& pose : poses) pose.T_w_b = T * pose.T_w_b;
  return poses;
}

/// What is not observable: yaw and place.
Pose otherFrame() { return {Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ())), {5, -3, 2}}; }

TEST(RefinedComparison, PlaceAndYawAreNoDifference) {
  const RefinedComparison c = compareWithRefined(moved(circle(), otherFrame()), circle(), {});
  EXPECT_LT(c.rms_m, 1e-9);
  EXPECT_NEAR(c.path_m, 2 * EIGEN_PI, 0.001);
}

TEST(RefinedComparison, ATiltAndAScaleAreDifferences) {
  // A scale of 1.1 moves each position of the circle by 0.1 m, a tilt of 0.1 rad by 0.1 m times |sin|, 0.0707 m rms.
  EXPECT_NEAR(compareWithRefined(circle(1.1), circle(), {}).rms_m, 0.1, 0.001);
  const Pose tilt{Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX())), Eigen::Vector3d::Zero()};
  EXPECT_NEAR(compareWithRefined(moved(circle(), tilt), circle(), {}).rms_m, 0.0707, 0.0005);
}

TEST(RefinedComparison, OnlyTimesThatBothHaveCount) {
  std::vector<OdometryPose> causal = circle(), refined = circle();
  causal.erase(causal.begin(), causal.begin() + 100);  // the start came late
  refined.erase(refined.begin() + 150);
  causal.back().t_ns += 1;
  causal.back().T_w_b.p.setConstant(1000);
  const RefinedComparison c = compareWithRefined(causal, refined, {});
  EXPECT_LT(c.rms_m, 1e-9);
  EXPECT_NEAR(c.path_m, EIGEN_PI, 0.05);
}

TEST(RefinedComparison, EachPieceHasAFrameOfItsOwn) {
  std::vector<OdometryPose> causal = circle();
  const std::vector<OdometryPose> later = moved(circle(), otherFrame());
  std::copy(later.begin() + 100, later.end(), causal.begin() + 100);
  EXPECT_GT(compareWithRefined(causal, circle(), {}).rms_m, 1);
  MapPiece first, second;
  first.last_ns = causal[99].t_ns;
  second.first_ns = causal[100].t_ns, second.last_ns = causal.back().t_ns;
  EXPECT_LT(compareWithRefined(causal, circle(), {first, second}).rms_m, 1e-9);
}

TEST(RefinedComparison, AContradictionIsMoreThanThreeCentimetresAndAHundredthOfTheWay) {
  OdometryResult result;
  result.trajectory = circle(1.08);  // 0.08 m on 6.28 m
  EXPECT_EQ(contradictionOf(result), "") << "nothing is refined";
  result.refined_trajectory = circle();
  EXPECT_EQ(contradictionOf(result), "");
  result.trajectory = circle(1.11);
  EXPECT_THAT(contradictionOf(result), HasSubstr("is 0.11 m (rms, over 6.3 m) away"));
  EXPECT_EQ(result.fault(), "");
  result.contradiction = contradictionOf(result);
  EXPECT_EQ(result.fault(), result.contradiction);
  result.verdict = "the estimate diverged";
  EXPECT_EQ(result.fault(), "the estimate diverged");
}

}  // namespace
}  // namespace lintel
