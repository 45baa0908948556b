// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/SplineTrajectory.h"

#include <gtest/gtest.h>

#include "TrajectoryChecks.h"
#include "lintel/simulation/FigureTrajectory.h"
#include "lintel/simulation/Random.h"

namespace lintel {
namespace {

StampedPoses posesOf(const Trajectory& trajectory, double noise_m = 0) {
  RandomStream random(3);
  StampedPoses poses;
  for (int k = 0; k <= 4000; ++k) {
    Pose T_w_b = trajectory.at(0.005 * k).T_w_b;
    T_w_b.p += random.gaussian3(noise_m);
    if (k % 3 == 0) T_w_b.q.coeffs() *= -1;  // the sign of a quaternion means nothing
    poses.emplace_back(1'400'000'000'000'000'000 + 5'000'000ll * k, T_w_b);
  }
  return poses;
}

TEST(SplineTrajectory, DerivativesAreThoseOfThePose) {
  const SplineTrajectory spline(posesOf(FigureTrajectory(), 0.005));
  EXPECT_NEAR(spline.duration(), 20, 1e-9);
  expectConsistent(spline, 0.1, 19.9);
}

TEST(SplineTrajectory, FollowsSlowMotionsClosely) {
  FigureParams slow;
  slow.shake = 0;
  const FigureTrajectory motion(slow);
  const SplineTrajectory spline(posesOf(motion));
  for (double t = 0.5; t < 19.5; t += 0.1) {
    const KinematicState a = motion.at(t), b = spline.at(t);
    ASSERT_LT((a.T_w_b.p - b.T_w_b.p).norm(), 1e-4);
    ASSERT_LT((a.v_w_b - b.v_w_b).norm(), 1e-3);
    ASSERT_LT(logRotation(a.T_w_b.q.conjugate() * b.T_w_b.q).norm(), 1e-4);
    ASSERT_LT((a.omega_b - b.omega_b).norm(), 2e-3);
  }
}

TEST(SplineTrajectory, SmoothsAJumpAway) {
  StampedPoses poses = posesOf(FigureTrajectory());
  for (std::size_t i = 2000; i < poses.size(); ++i) poses[i].second.p.x() += 0.1;  // as motion capture sometimes has
  const SplineTrajectory spline(poses);
  double most = 0;
  for (double t = 9; t < 11; t += 0.01) most = std::max(most, spline.at(t).a_w_b.norm());
  EXPECT_LT(most, 15);  // at full bandwidth it would be thousands
  expectConsistent(spline, 9, 11);
}

TEST(SplineTrajectory, UnusablePosesAreRefused) {
  StampedPoses poses = posesOf(FigureTrajectory());
  EXPECT_THROW(SplineTrajectory(StampedPoses(poses.begin(), poses.begin() + 5)), std::invalid_argument);
  EXPECT_THROW(SplineTrajectory(StampedPoses(poses.begin(), poses.begin() + 100)), std::invalid_argument);
  std::swap(poses[10], poses[20]);
  EXPECT_THROW(SplineTrajectory{poses}, std::invalid_argument);
}

}  // namespace
}  // namespace lintel
