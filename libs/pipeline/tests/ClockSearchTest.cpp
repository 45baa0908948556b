// SPDX-License-Identifier: BSD-3-Clause
#include "ClockSearch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "MadeRecording.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr double kStampSigma_s = 0.002;

/// Grey level of what is seen in a direction: blobs on a sphere, far away.
double brightness(const Eigen::Vector3d& d) {
  return 128 + 40 * std::sin(23 * d.x() + 9 * d.y()) * std::sin(19 * d.y() - 5 * d.z()) +
         40 * std::sin(31 * d.y() + 7 * d.x()) * std::sin(27 * d.x() + 11 * d.z());
}

Rig turnedRig() {
  Rig rig;
  rig.camera = {200, 150, 160, 160, 99.5, 74.5, 0, 0, 0, 0};
  rig.T_b_c.q = expRotation({0.3, -0.2, 1.5});
  return rig;
}

/// A camera that turns among far blobs; an image with stamp t shows the world at t + offset of the IMU's clock.
class TurningRecording : public test::MadeRecording {
 public:
  explicit TurningRecording(double offset_s, double rate = 1, int frames = 100, std::string complaint = "",
                            double still_s = 0)
      : MadeRecording(turnedRig(), frames, std::move(complaint)), offset_s_(offset_s), rate_(rate), still_s_(still_s) {}

 private:
  Eigen::Quaterniond R_w_b(double t_s) const {
    const double t = std::max(0.0, t_s - still_s_);
    return expRotation(
        rate_ * Eigen::Vector3d(0.12 * std::sin(3.1 * t), 0.1 * std::sin(4.3 * t + 1), 0.15 * std::sin(2.3 * t)));
  }
  Eigen::Vector3d gyroAt(double t_s) const override {
    constexpr double kHalf_s = 1e-3;
    return logRotation(R_w_b(t_s - kHalf_s).conjugate() * R_w_b(t_s + kHalf_s)) / (2 * kHalf_s);
  }
  std::shared_ptr<const GrayImage> imageAt(double t_s) const override {
    const Eigen::Matrix3d R_w_c = (R_w_b(t_s + offset_s_) * rig().T_b_c.q).toRotationMatrix();
    const Camera& camera = rig().camera;
    auto image = std::make_shared<GrayImage>(GrayImage{camera.width, camera.height, {}});
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
        image->pixels.push_back(static_cast<std::uint8_t>(brightness(R_w_c * ray.normalized())));
      }
    return image;
  }

  double offset_s_, rate_, still_s_;
};

FrontEndParams points() {
  FrontEndParams params;
  params.features = "points";
  return params;
}

TEST(ClockSearch, FindsOffsetsWithinATenthOfASecond) {
  for (const double offset_s : {-0.09, -0.045, 0.03, 0.09}) {
    TurningRecording recording(offset_s);
    OdometryResult result;
    TrackingStage tracking(recording, points(), result);
    const ClockSearch search = searchClock(tracking, recording.rig(), kStampSigma_s);
    EXPECT_NEAR(search.offset_s, offset_s, 0.004) << offset_s;
    EXPECT_GE(search.sigma_s, search.clock.sigma_s) << "it covers stamps that are right";
  }
}

TEST(ClockSearch, LeavesGoodStampsAlone) {
  TurningRecording recording(0.002);
  OdometryResult result;
  TrackingStage tracking(recording, points(), result);
  const ClockSearch search = searchClock(tracking, recording.rig(), kStampSigma_s);
  EXPECT_TRUE(search.clock.determined);
  EXPECT_EQ(search.offset_s, 0);
  EXPECT_EQ(search.sigma_s, kStampSigma_s);
  EXPECT_LT(search.frames.size(), 60u) << "it ends when it knows";
}

/// Cameras without a trigger are usually some milliseconds off, not anything up to a tenth of a second.
TEST(ClockSearch, CorrectsASmallOffsetToo) {
  TurningRecording recording(0.0065, 0.2);
  OdometryResult result;
  TrackingStage tracking(recording, points(), result);
  const ClockSearch search = searchClock(tracking, recording.rig(), kStampSigma_s);
  EXPECT_NEAR(search.offset_s, 0.0065, 0.002);
  EXPECT_LT(search.sigma_s, 0.004);
}

/// A recording usually begins with a camera that lies still, which shows nothing.
TEST(ClockSearch, WaitsForTheFirstTurn) {
  TurningRecording recording(0.05, 1, 260, "", 8);
  OdometryResult result;
  TrackingStage tracking(recording, points(), result);
  const ClockSearch search = searchClock(tracking, recording.rig(), kStampSigma_s);
  EXPECT_NEAR(search.offset_s, 0.05, 0.004);
}

TEST(ClockSearch, WithoutTurnsItTakesAllThereIsAndSaysNothing) {
  TurningRecording recording(0.05, 0, 140);
  OdometryResult result;
  TrackingStage tracking(recording, points(), result);
  const ClockSearch search = searchClock(tracking, recording.rig(), kStampSigma_s);
  EXPECT_EQ(search.offset_s, 0);
  EXPECT_FALSE(search.clock.determined);
  EXPECT_EQ(search.frames.size(), 140u);
}

/// Tracking goes on as if there had been no search.
TEST(ClockSearch, ItsFramesAreHandedOn) {
  TurningRecording searched(0, 1, 70, "cut off"), plain(0, 1, 70, "cut off");
  OdometryResult result, expected;
  TrackingStage tracking(searched, points(), result), reference(plain, points(), expected);
  ClockSearch search = searchClock(tracking, searched.rig(), kStampSigma_s);
  ASSERT_GT(search.frames.size(), 20u);
  tracking.giveAgain(std::move(search.frames));
  int frames = 0;
  while (const auto frame = tracking.next()) {
    const auto other = reference.next();
    ASSERT_TRUE(other);
    EXPECT_EQ(frame->step.frame.t_ns, other->step.frame.t_ns);
    ASSERT_EQ(frame->tracks.points.size(), other->tracks.points.size());
    for (std::size_t i = 0; i < frame->tracks.points.size(); ++i)
      EXPECT_EQ(frame->tracks.points[i].px, other->tracks.points[i].px);
    ++frames;
  }
  EXPECT_EQ(frames, 70);
  EXPECT_EQ(result.error, "cut off");
  EXPECT_EQ(result.statistics.tracking.ms().size(), 70u);
  EXPECT_FALSE(tracking.next()) << "the end stays the end";
}

}  // namespace
}  // namespace lintel
