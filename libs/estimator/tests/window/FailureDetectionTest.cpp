// SPDX-License-Identifier: BSD-3-Clause
#include "window/FailureDetection.h"

#include <gtest/gtest.h>

#include <limits>

#include "TestWindow.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using namespace test;

class FailureDetectionTest : public testing::Test {
 protected:
  WindowFrame& newest() { return window_.frames.back(); }
  std::string failure() const { return findFailure(window_, params_, at(1, 0, 0)); }

  FailureParams params_;
  SlidingWindow window_ = windowAt({at(0, 0, 0), at(1, 0, 0)});
};

TEST_F(FailureDetectionTest, AGoodWindowIsNoFailure) { EXPECT_EQ(failure(), ""); }

TEST_F(FailureDetectionTest, NumbersThatAreNone) {
  newest().pose[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(failure(), "the estimate is not finite");
  newest().pose = toBlock(at(1, 0, 0));
  newest().motion[4] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(failure(), "the estimate is not finite");
}

TEST_F(FailureDetectionTest, ImplausibleBiases) {
  newest().motion.segment<3>(kBiasAccelAt) << 0, 0.99 * params_.max_bias_accel, 0;
  EXPECT_EQ(failure(), "");
  newest().motion.segment<3>(kBiasAccelAt) << 0, 1.01 * params_.max_bias_accel, 0;
  EXPECT_EQ(failure(), "the accelerometer bias is implausible");
  newest().motion.setZero();
  newest().motion.segment<3>(kBiasGyroAt) << 0, 0, -1.01 * params_.max_bias_gyro;
  EXPECT_EQ(failure(), "the gyroscope bias is implausible");
}

TEST_F(FailureDetectionTest, JumpsAwayFromThePrediction) {
  newest().pose = toBlock(at(1, 0.99 * params_.max_step_m, 0));
  EXPECT_EQ(failure(), "");
  newest().pose = toBlock(at(1, 1.01 * params_.max_step_m, 0));
  EXPECT_EQ(failure(), "the position jumped away from the IMU's prediction");
  newest().pose = toBlock(Pose{expRotation({1.01 * params_.max_step_rad, 0, 0}), {1, 0, 0}});
  EXPECT_EQ(failure(), "the orientation jumped away from the IMU's prediction");
}

/// A camera that moves sideways past points; of every ten `placed` are triangulated. All of the `far` ones are, which
/// do not move in the images.
PlacementCheck checkOf(int frames, int points, int placed, double step_m, int far = 0) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(step_m, 0, 0), at(2 * step_m, 0, 0)});
  for (int i = 0; i < points; ++i)
    for (FrameId frame = 0; frame < 3; ++frame)
      seePoint(window, static_cast<TrackId>(i) + 1, frame, {0.1 * i, 0.1 * (i % 3), 5});
  int i = 0;
  for (auto& [id, track] : window.points) track.triangulated = i++ % 10 < placed;
  for (int k = 0; k < far; ++k) {
    const auto id = static_cast<TrackId>(points + k) + 1;
    for (FrameId frame = 0; frame < 3; ++frame) seePoint(window, id, frame, {2.0 * k, 3.0 * (k % 3), 100});
    window.points.at(id).triangulated = true;
  }
  PlacementCheck check;
  for (int k = 0; k < frames; ++k) check.add(window);
  return check;
}

TEST(PlacementCheck, PointsThatMoveAndHaveNoPlaceContradictTheMotion) {
  EXPECT_TRUE(checkOf(20, 10, 4, 0.1).contradicted(false));
  EXPECT_FALSE(checkOf(20, 10, 6, 0.1).contradicted(false));
  EXPECT_FALSE(checkOf(10, 10, 4, 0.1).contradicted(false)) << "as when a vehicle takes off";
  EXPECT_TRUE(checkOf(12, 10, 4, 0.1).contradicted(true));
}

TEST(PlacementCheck, ContradictsNothingWhileMostOfAllPointsHavePlaces) {
  EXPECT_FALSE(checkOf(20, 10, 0, 0.1, 12).contradicted(false)) << "points of noise slide before a camera that stands";
  EXPECT_TRUE(checkOf(20, 10, 0, 0.1, 8).contradicted(false));
  EXPECT_TRUE(checkOf(20, 10, 0, 0.1, 12).contradicted(true)) << "another start costs little";
}

TEST(PlacementCheck, AFewSayNothing) { EXPECT_FALSE(checkOf(20, 4, 0, 0.1).contradicted(true)); }

TEST(PlacementCheck, PointsWithoutParallaxNeedNoPlace) { EXPECT_FALSE(checkOf(20, 10, 0, 0.01).contradicted(true)); }

}  // namespace
}  // namespace lintel
