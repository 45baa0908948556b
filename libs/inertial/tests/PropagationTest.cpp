// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/Propagation.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// One second of constant readings.
Preintegration constantReadings(const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel, const ImuBias& bias) {
  Preintegration imu(bias, {});
  ImuBatch samples;
  for (int i = 0; i <= 200; ++i) samples.push_back({i * 5'000'000, gyro, accel});
  imu.append(samples);
  return imu;
}

TEST(Propagation, ABodyThatIsHeldUpGoesStraightOn) {
  InertialState from;
  from.T_w_b = {expRotation({0.2, -0.1, 0.4}), {1, 2, 3}};
  from.v_w_b = {0.5, -0.2, 0.1};
  from.bias = {{0.01, 0.02, -0.03}, {0.1, -0.2, 0.05}};
  const Eigen::Vector3d held = from.T_w_b.q.conjugate() * -gravityW();
  const InertialState to = propagated(from, constantReadings(from.bias.gyro, held + from.bias.accel, from.bias));
  EXPECT_LT((to.T_w_b.p - (from.T_w_b.p + from.v_w_b)).norm(), 1e-9);
  EXPECT_LT((to.v_w_b - from.v_w_b).norm(), 1e-9);
  EXPECT_LT(to.T_w_b.q.angularDistance(from.T_w_b.q), 1e-9);
  EXPECT_EQ(to.bias.gyro, from.bias.gyro);
  EXPECT_EQ(to.bias.accel, from.bias.accel);
}

TEST(Propagation, ABodyThatFallsFollowsTheParabola) {
  const InertialState to = propagated({}, constantReadings(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), {}));
  EXPECT_LT((to.T_w_b.p - 0.5 * gravityW()).norm(), 1e-9);
  EXPECT_LT((to.v_w_b - gravityW()).norm(), 1e-9);
}

TEST(Propagation, ABodyFallsAsFastAsGravitySays) {
  Preintegration imu({}, {}, 1.62);
  imu.append({{0, {0, 0, 0}, {0, 0, 0}}, {1'000'000'000, {0, 0, 0}, {0, 0, 0}}});
  EXPECT_NEAR(propagated({}, imu).T_w_b.p.z(), -0.81, 1e-9);
  EXPECT_NEAR(propagated({}, imu).v_w_b.z(), -1.62, 1e-9);
}

TEST(Propagation, MisfitIsMeasuredByTheCovariance) {
  const Preintegration imu = constantReadings(Eigen::Vector3d::Zero(), -gravityW(), {});
  const InertialState from, there = propagated(from, imu);
  EXPECT_NEAR(squaredMisfit(from, there, imu), 0, 1e-9);
  InertialState off = there;
  const double sigma =
      2e-3;  // of a second of ImuNoise's accelerometer [m/s]; position follows as far as it is correlated
  off.v_w_b.y() += sigma;
  off.T_w_b.p.y() += 0.5 * sigma;
  const double expected = squaredMisfit(from, off, imu);
  EXPECT_NEAR(expected, 1, 0.1) << "one standard deviation";
  off.v_w_b.y() += sigma;
  off.T_w_b.p.y() += 0.5 * sigma;
  EXPECT_NEAR(squaredMisfit(from, off, imu), 4 * expected, 1e-6);
  off = there;
  off.T_w_b.q = off.T_w_b.q * expRotation({0, 0, 3 * 1.6968e-4});  // about the vertical: it turns no acceleration
  EXPECT_NEAR(squaredMisfit(from, off, imu), 9, 0.1);
}

}  // namespace
}  // namespace lintel
