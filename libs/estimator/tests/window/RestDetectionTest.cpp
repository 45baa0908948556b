// SPDX-License-Identifier: BSD-3-Clause
#include "window/RestDetection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

constexpr int kPoints = 40;
constexpr double kFocal_px = 500;

/// 0.05 s of an IMU at rest that trembles by `gyro` and `accel`, and turns by `turn_rad_s`.
std::shared_ptr<Preintegration> trembling(double gyro, double accel, double turn_rad_s = 0) {
  ImuBatch batch;
  for (int i = 0; i <= 10; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;
    batch.push_back({i * 5'000'000LL, {turn_rad_s + sign * gyro, 0, 0}, {0, sign * accel, 9.81}});
  }
  auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
  imu->append(batch);
  return imu;
}

/// Three frames at one place that see points 5 m away; the last interval has the IMU given.
SlidingWindow resting(const std::shared_ptr<Preintegration>& imu) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0, 0, 0), at(0, 0, 0)});
  for (int i = 0; i < kPoints; ++i)
    for (FrameId k = 0; k < 3; ++k) seePoint(window, static_cast<TrackId>(i), k, {0.05 * i - 1, 0.1 * (i % 7), 5});
  window.frames[2].imu = imu;
  return window;
}

TEST(Quiet, ImagesAndImuMustAgree) {
  const EstimatorParams params;
  EXPECT_TRUE(isQuiet(resting(trembling(0.005, 0.1)), params));
  EXPECT_FALSE(isQuiet(resting(trembling(2 * params.initializer.static_gyro_std, 0.1)), params));
  EXPECT_FALSE(isQuiet(resting(trembling(0.005, 2 * params.initializer.static_accel_std)), params));
  EXPECT_FALSE(isQuiet(resting(nullptr), params)) << "no IMU";
  SlidingWindow moving = resting(trembling(0.005, 0.1));
  for (auto& [id, track] : moving.points) track.sightings.back().observation.ray.x() += 1.0 / kFocal_px;
  EXPECT_FALSE(isQuiet(moving, params));
}

TEST(Quiet, IsNotASlowUniformMotionFarFromAllPoints) {
  // 10 cm/s, 20 m away: 0.2 px in a tenth of a second, and the IMU shows nothing
  SlidingWindow slow = resting(trembling(0.005, 0.1));
  for (auto& [id, track] : slow.points) track.sightings.back().observation.ray.x() += 0.2 / 458;
  EXPECT_TRUE(isQuiet(slow, {}));
  slow.frames.back().motion[kVelocityAt] = 0.1;
  EXPECT_FALSE(isQuiet(slow, {}));
}

/// Windows whose newest frame comes a tenth of a second after that of the window before, motors running.
class TremblingRest : public testing::Test {
 protected:
  /// `px_per_s`: how fast all points move in the image.
  bool after(double seconds, double px_per_s, double turn_rad_s = 0, const EstimatorParams& params = {}) {
    RestDetection rest(params);
    bool at_rest = false;
    for (int frame = 0; frame <= std::lround(10 * seconds); ++frame) {
      SlidingWindow window = resting(trembling(0.1, 1.5, turn_rad_s));
      window.frames.back().t_ns = frame * 100'000'000LL;
      window.frames.back().motion[kVelocityAt] = 0.2;  // what the vibration has made of the estimate
      for (auto& [id, track] : window.points)
        track.sightings.back().seen_px += Eigen::Vector2d(0.1 * frame * px_per_s, 0.05 * (frame % 2));
      rest.add(window);
      at_rest = rest.atRest(window);
    }
    return at_rest;
  }
};

TEST_F(TremblingRest, IsSeenWhenImagesHaveBeenStillForASecond) {
  EXPECT_FALSE(after(0.9, 0));
  EXPECT_TRUE(after(1.0, 0));
  EXPECT_TRUE(after(3.0, 0.5)) << "tracks drift";
}

TEST_F(TremblingRest, IsNotASlowMotion) {
  EXPECT_FALSE(after(3.0, 2.3)) << "10 cm/s, 20 m away";
  EXPECT_FALSE(after(3.0, 1.2));
}

TEST_F(TremblingRest, IsNotAnImageThatMovesAlong) {
  // what the camera sees turns with it: a dirty lens, its own vehicle
  EXPECT_FALSE(after(2.0, 0, 0.2));
}

TEST_F(TremblingRest, CanBeSwitchedOff) {
  EstimatorParams params;
  params.detect_rest = false;
  EXPECT_FALSE(after(3.0, 0, 0, params));
}

}  // namespace
}  // namespace lintel
