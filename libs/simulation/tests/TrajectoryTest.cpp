// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/Trajectory.h"

#include <gtest/gtest.h>

#include "TrajectoryChecks.h"
#include "lintel/geometry/Frames.h"
#include "lintel/simulation/FigureTrajectory.h"

namespace lintel {
namespace {

TEST(FigureTrajectory, DerivativesAreThoseOfThePose) { expectConsistent(FigureTrajectory(), 0.1, 40); }

TEST(FigureTrajectory, RandomPhasesAreConsistentToo) {
  FigureParams params;
  params.seed = 7;
  expectConsistent(FigureTrajectory(params), 0.1, 40);
}

TEST(FigureTrajectory, HasTheDynamicsOfAFlightAndStaysInItsVolume) {
  const FigureParams params;
  const FigureTrajectory trajectory(params);
  double mean_speed = 0, max_accel = 0, max_rate = 0;
  Eigen::Vector3d rates = Eigen::Vector3d::Zero();
  for (int i = 0; i < 6000; ++i) {
    const KinematicState s = trajectory.at(0.01 * i);
    mean_speed += s.v_w_b.norm() / 6000;
    max_accel = std::max(max_accel, s.a_w_b.norm());
    max_rate = std::max(max_rate, s.omega_b.norm());
    rates = rates.cwiseMax(s.omega_b.cwiseAbs());
    ASSERT_TRUE(((s.T_w_b.p - params.centre).cwiseAbs().array() <= params.half_extent.array() + 1e-12).all());
  }
  EXPECT_GT(mean_speed, 0.5);
  EXPECT_LT(mean_speed, 1.5);
  EXPECT_GT(max_accel, 2);
  EXPECT_LT(max_accel, 6);
  EXPECT_GT(max_rate, 0.6);
  EXPECT_LT(max_rate, 1.3);
  EXPECT_GT(rates.minCoeff(), 0.2);  // every axis is excited
}

TEST(FigureTrajectory, PureTranslationAndPureRotation) {
  FigureParams still_attitude, still_position;
  still_attitude.rotation = 0;
  still_position.translation = 0;
  const FigureTrajectory translation(still_attitude), rotation(still_position);
  for (double t = 0; t < 20; t += 0.37) {
    EXPECT_EQ(translation.at(t).omega_b.norm(), 0);
    EXPECT_EQ(rotation.at(t).v_w_b.norm(), 0);
  }
  EXPECT_GT(translation.at(3).v_w_b.norm(), 0.1);
  EXPECT_GT(rotation.at(3).omega_b.norm(), 0.05);
}

TEST(FigureTrajectory, CameraLooksHorizontallyAtHeadingZero) {
  FigureParams params;
  params.rotation = params.pitch_rad = 0;
  const Eigen::Quaterniond R_b_c = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3).normalized();
  const Eigen::Quaterniond R_w_c = FigureTrajectory(params, R_b_c).at(1).T_w_b.q * R_b_c;
  EXPECT_NEAR((R_w_c * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 0, 1e-12);  // forward
  EXPECT_NEAR((R_w_c * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);  // image down = down
}

TEST(DelayedStart, HoldsStillThenFollows) {
  const auto motion = std::make_shared<FigureTrajectory>();
  const DelayedStart delayed(motion, 2.0, 1.5);
  for (const double t : {0.0, 1.0, 2.0}) {
    EXPECT_EQ(delayed.at(t).v_w_b.norm(), 0);
    EXPECT_EQ(delayed.at(t).a_w_b.norm(), 0);
    EXPECT_EQ(delayed.at(t).omega_b.norm(), 0);
    EXPECT_EQ((delayed.at(t).T_w_b.p - motion->at(0).T_w_b.p).norm(), 0);
  }
  const KinematicState late = delayed.at(2.0 + 1.5 + 3.0), expected = motion->at(0.75 + 3.0);
  EXPECT_NEAR((late.v_w_b - expected.v_w_b).norm(), 0, 1e-12);
  expectConsistent(delayed, 1.9, 8);
}

}  // namespace
}  // namespace lintel
