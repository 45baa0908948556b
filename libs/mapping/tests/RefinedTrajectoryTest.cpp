// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/BatchRefinement.h"

namespace lintel {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// Constant acceleration a along x from rest, two keyframes one second apart, frames every 0.1 s from 0 to 1.2 s.
class RefinedTrajectoryTest : public testing::Test {
 protected:
  static constexpr double kAcceleration = 2;

  RefinedTrajectoryTest() { giveImu({0, 0, 0, 0}); }

  /// The second keyframe's IMU: the same samples, with other densities.
  void giveImu(const ImuNoise& noise) {
    causal_ = {};
    auto imu = std::make_shared<Preintegration>(ImuBias{}, noise);
    ImuBatch samples;
    for (int i = 0; i <= 200; ++i) samples.push_back({kSecond / 200 * i, {0, 0, 0}, {kAcceleration, 0, kGravity}});
    imu->append(samples);
    causal_.keyframes.resize(2);
    causal_.keyframes[1].id = 1;
    causal_.keyframes[1].t_ns = kSecond;
    causal_.keyframes[1].T_w_b.p = {kAcceleration / 2, 0, 0};
    causal_.keyframes[1].v_w_b = {kAcceleration, 0, 0};
    causal_.keyframes[1].imu = imu;
    for (int i = 0; i <= 12; ++i) {
      const double t = 0.1 * i;
      causal_.trajectory.emplace_back(kSecond / 10 * i,
                                      Pose{{1, 0, 0, 0}, {kAcceleration / 2 * t * t, 0.03 * (i % 2), 0}});
    }
  }
  MapMaterial causal_;
};

TEST_F(RefinedTrajectoryTest, TheImuCarriesStatesBetweenKeyframes) {
  const auto refined = refinedTrajectory(causal_, causal_.keyframes);
  ASSERT_EQ(refined.size(), 13u) << "every frame has a pose";
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.1 * i;
    EXPECT_EQ(refined[static_cast<std::size_t>(i)].first, kSecond / 10 * i);
    EXPECT_LT((refined[static_cast<std::size_t>(i)].second.p - Eigen::Vector3d(kAcceleration / 2 * t * t, 0, 0)).norm(),
              1e-9)
        << "the causal jitter is gone";
  }
}

TEST_F(RefinedTrajectoryTest, AnImuAsImpreciseAsTheImagesHasHalfOfTheSay) {
  // half way through a second: q^2 T^3 / 48 and (g q)^2 T^5 / 480 are the 5 mm of the causal trajectory
  giveImu({0, 0, 0.005 * std::sqrt(48), 0});
  EXPECT_NEAR(refinedTrajectory(causal_, causal_.keyframes)[5].second.p.y(), 0.5 * 0.03, 1e-9);
  giveImu({0.005 * std::sqrt(480) / kGravity, 0, 0, 0});
  EXPECT_NEAR(refinedTrajectory(causal_, causal_.keyframes)[5].second.p.y(), 0.5 * 0.03, 1e-9);
}

TEST_F(RefinedTrajectoryTest, WhatIsMissingIsSpreadOverTheInterval) {
  std::vector<RetiredKeyframe> moved = causal_.keyframes;
  moved[1].T_w_b.p += Eigen::Vector3d(0, 0.1, 0);
  const auto refined = refinedTrajectory(causal_, moved);
  EXPECT_LT(refined[0].second.p.norm(), 1e-9);
  EXPECT_NEAR(refined[5].second.p.y(), 0.05, 1e-9);  // half way by symmetry
  EXPECT_NEAR(refined[1].second.p.y(), 0.1 * (3 * 0.01 - 2 * 0.001), 1e-9) << "no kink at the keyframe";
  EXPECT_NEAR(refined[10].second.p.y(), 0.1, 1e-9);
}

TEST_F(RefinedTrajectoryTest, FramesOutsideMoveWithTheNearestKeyframe) {
  std::vector<RetiredKeyframe> moved = causal_.keyframes;
  moved[1].T_w_b.p += Eigen::Vector3d(0, 0.1, 0);
  const auto refined = refinedTrajectory(causal_, moved);
  EXPECT_LT((refined[12].second.p - causal_.trajectory[12].second.p - Eigen::Vector3d(0, 0.1, 0)).norm(), 1e-9);
}

TEST_F(RefinedTrajectoryTest, WithoutImuFramesMoveWithTheKeyframeBefore) {
  causal_.keyframes[1].imu = nullptr;  // a new start
  std::vector<RetiredKeyframe> moved = causal_.keyframes;
  moved[0].T_w_b.p += Eigen::Vector3d(0, 0, 0.2);
  const auto refined = refinedTrajectory(causal_, moved);
  EXPECT_NEAR(refined[7].second.p.z(), 0.2, 1e-9);
  EXPECT_NEAR(refined[11].second.p.z(), 0, 1e-9);
}

/// At rest for ten seconds between two keyframes, with an IMU whose angular rate errs: its bias changes on the way.
class RestBetweenKeyframesTest : public testing::Test {
 protected:
  RestBetweenKeyframesTest() {
    auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{1.4e-3, 1e-5, 1.6e-2, 1e-4});
    ImuBatch samples;
    for (int i = 0; i <= 2000; ++i)
      samples.push_back({kSecond / 200 * i, {i < 1000 ? 0.002 : -0.002, 0, 0}, {0, 0, kGravity}});
    imu->append(samples);
    causal_.keyframes.resize(2);
    causal_.keyframes[1].id = 1;
    causal_.keyframes[1].t_ns = 10 * kSecond;
    causal_.keyframes[1].imu = imu;
    for (int i = 0; i <= 100; ++i) causal_.trajectory.emplace_back(kSecond / 10 * i, Pose{});
  }
  MapMaterial causal_;
};

TEST_F(RestBetweenKeyframesTest, WhereTheImuDriftsTheImagesOfTheCausalTrajectoryDecide) {
  const auto refined = refinedTrajectory(causal_, causal_.keyframes);
  ASSERT_EQ(refined.size(), 101u);
  for (const auto& [t_ns, T_w_b] : refined)
    EXPECT_LT(T_w_b.p.norm(), 0.01) << 1e-9 * static_cast<double>(t_ns) << " s; the IMU alone leads 20 cm away";
}

TEST_F(RestBetweenKeyframesTest, TheCausalWayIsBentToMeetTheRefinedKeyframes) {
  std::vector<RetiredKeyframe> moved = causal_.keyframes;
  moved[0].T_w_b.q = expRotation(Eigen::Vector3d(0, 0, M_PI / 2));
  moved[0].T_w_b.p = {1, 0, 0};
  moved[1].T_w_b.q = moved[0].T_w_b.q;
  moved[1].T_w_b.p = {1, 0.1, 0};
  const auto refined = refinedTrajectory(causal_, moved);
  EXPECT_LT((refined.front().second.p - moved[0].T_w_b.p).norm(), 1e-9);
  EXPECT_LT((refined[50].second.p - Eigen::Vector3d(1, 0.05, 0)).norm(), 0.01);
  EXPECT_LT((refined.back().second.p - moved[1].T_w_b.p).norm(), 1e-9);
}

}  // namespace
}  // namespace lintel
