// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/SecondTry.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

/// Of a hundred frames, of which every second enters the window.
OdometryResult runWithPoses(std::size_t poses, std::size_t waiting, std::size_t without_scale) {
  OdometryResult result;
  result.statistics.frames = 100;
  result.statistics.frames_with_pose = poses;
  result.statistics.frames_waiting = waiting;
  result.statistics.frames_without_scale = without_scale;
  result.trajectory.resize(poses);
  return result;
}

OdometryResult refined(std::size_t poses) {
  OdometryResult result = runWithPoses(poses, 10, 5);
  result.refinement.accepted = true;
  result.refined_trajectory.resize(poses);
  return result;
}

TEST(SecondTry, StampsAreUsedAsTheyAreWhereNoPoseWasFoundWithCorrectedOnes) {
  OdometryResult none = runWithPoses(0, 50, 0);
  EXPECT_FALSE(mayHaveWrongClock(none)) << "they were not corrected";
  none.clock_offset_s = -0.02;
  EXPECT_TRUE(mayHaveWrongClock(none));
  EXPECT_TRUE(hasPoses(runWithPoses(3, 40, 0), none));
  EXPECT_FALSE(hasPoses(runWithPoses(0, 50, 0), none));
  OdometryResult some = runWithPoses(5, 40, 0);
  some.clock_offset_s = -0.02;
  EXPECT_FALSE(mayHaveWrongClock(some));
  none.cancelled = true;
  EXPECT_FALSE(mayHaveWrongClock(none));
  Configuration configuration;
  EXPECT_FALSE(asStamped(configuration).estimator.calibration.find_clock_offset);
  configuration.estimator.calibration.find_clock_offset = false;
  EXPECT_EQ(writeConfiguration(asStamped({})), writeConfiguration(configuration)) << "nothing else";
}

TEST(SecondTry, IsWantedWhereTheScaleIsWhatIsMissing) {
  EXPECT_TRUE(lacksScale(runWithPoses(0, 50, 30)));
  EXPECT_TRUE(lacksScale(runWithPoses(20, 40, 30)));
  EXPECT_FALSE(lacksScale(runWithPoses(60, 20, 15))) << "it has poses";
  EXPECT_FALSE(lacksScale(runWithPoses(0, 50, 3))) << "something else is missing";
  EXPECT_FALSE(lacksScale(runWithPoses(0, 50, 0)));
}

TEST(SecondTry, IsNotWantedOfARunThatEndedEarly) {
  OdometryResult result = runWithPoses(0, 50, 30);
  result.cancelled = true;
  EXPECT_FALSE(lacksScale(result));
  result = runWithPoses(0, 50, 30);
  result.error = "flight.rawlog: cut off";
  EXPECT_FALSE(lacksScale(result));
}

TEST(SecondTry, ChangesNothingButTheStart) {
  Configuration configuration;
  configuration.estimator.keyframes = 7;
  const Configuration second = secondTryOf(configuration);
  EXPECT_GT(second.estimator.initializer.max_scale_sigma, configuration.estimator.initializer.max_scale_sigma);
  Configuration same = second;
  same.estimator.initializer.max_scale_sigma = configuration.estimator.initializer.max_scale_sigma;
  EXPECT_EQ(writeConfiguration(same), writeConfiguration(configuration));
  configuration.estimator.initializer.max_scale_sigma = 0.3;
  EXPECT_EQ(writeConfiguration(secondTryOf(configuration)), writeConfiguration(configuration)) << "as given";
}

TEST(SecondTry, CountsWhereItIsRefinedAndHasMorePoses) {
  const OdometryResult none = runWithPoses(0, 50, 30), few = runWithPoses(20, 40, 30);
  EXPECT_TRUE(isBetter(refined(80), none));
  EXPECT_TRUE(isBetter(refined(80), few));
  EXPECT_FALSE(isBetter(refined(10), few));
  EXPECT_FALSE(isBetter(runWithPoses(80, 10, 5), none)) << "causal poses alone may have any scale";
  OdometryResult wrong = refined(80);
  wrong.verdict = "images and IMU contradict each other";
  EXPECT_FALSE(isBetter(wrong, none));
  OdometryResult cancelled = refined(80);
  cancelled.cancelled = true;
  EXPECT_FALSE(isBetter(cancelled, none));
}

TEST(SecondTry, ItsResultIsNotToBeTrusted) {
  OdometryResult second = refined(80);
  second.refinement.scale_sigma = 0.0123;
  EXPECT_NE(verdictOfSecondTry(second).find("1.2 %"), std::string::npos) << verdictOfSecondTry(second);
}

}  // namespace
}  // namespace lintel
