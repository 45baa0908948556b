// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/Propagation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// One second of constant readings.
Preintegration constantReadings(const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel, const ImuBias& bias) {
  Preintegration imu(bias, {});
  ImuBatch samples;
  for (int i = 0; i <= 200; ++i) samples.push_back({i * 5'000'000LL, gyro, accel});
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

TEST(Propagation, IntegratesToTimesOnAndBetweenSamples) {
  // falling, sampled every 0.1 s from 2 s on; the acceleration that is felt grows by 1 m/s^3
  Preintegration whole({}, {});
  ImuBatch samples;
  for (std::int64_t i = 0; i <= 10; ++i)
    samples.push_back({2'000'000'000 + 100'000'000 * i, {0, 0, 0}, {0.1 * static_cast<double>(i), 0, 0}});
  whole.append(samples);
  const auto imu = integratedTo({}, whole, {2'000'000'000, 2'300'000'000, 2'350'000'000, 3'000'000'000});
  ASSERT_EQ(imu.size(), 4u);
  const double times_s[] = {0, 0.3, 0.35, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    const InertialState to = propagated({}, imu[i]);
    EXPECT_NEAR(imu[i].dt_s(), times_s[i], 1e-12);
    EXPECT_NEAR(to.v_w_b.x(), 0.5 * times_s[i] * times_s[i], 1e-9) << "the trapezoid rule is exact here";
    EXPECT_NEAR(to.v_w_b.z(), gravityW().z() * times_s[i], 1e-9);
  }
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
  EXPECT_NEAR(squaredAccelMisfit(from, off, imu), 0, 1e-9) << "the rotation does not count";
  off = there;
  off.v_w_b.y() += sigma;
  off.T_w_b.p.y() += 0.5 * sigma;
  EXPECT_LT(squaredAccelMisfit(from, off, imu), expected) << "a tilt that nothing else contradicts explains a part";
  EXPECT_GT(squaredAccelMisfit(from, off, imu), 0.2 * expected);
}

/// What `to` differs from `from` by, in the order of StateCovariance.
Eigen::Matrix<double, 15, 1> difference(const InertialState& to, const InertialState& from) {
  Eigen::Matrix<double, 15, 1> d;
  d << to.T_w_b.p - from.T_w_b.p, logRotation(from.T_w_b.q.conjugate() * to.T_w_b.q), to.v_w_b - from.v_w_b,
      to.bias.gyro - from.bias.gyro, to.bias.accel - from.bias.accel;
  return d;
}

InertialState moved(const InertialState& from, const Eigen::Matrix<double, 15, 1>& d) {
  InertialState to = from;
  to.T_w_b.p += d.head<3>();
  to.T_w_b.q = from.T_w_b.q * expRotation(d.segment<3>(3));
  to.v_w_b += d.segment<3>(6);
  to.bias.gyro += d.segment<3>(9);
  to.bias.accel += d.tail<3>();
  return to;
}

TEST(Propagation, CovarianceIsCarriedAsErrorsAre) {
  const Preintegration imu = constantReadings({0.3, -0.5, 0.8}, {1, -2, 9}, {{0.01, 0, 0}, {0, 0.1, 0}});
  InertialState from;
  from.T_w_b = {expRotation({0.2, -0.6, 0.4}), {1, 2, 3}};
  from.v_w_b = {0.5, -0.2, 0.1};
  from.bias = imu.bias();
  constexpr double kStep = 1e-6;
  StateCovariance by_state;
  for (int k = 0; k < 15; ++k) {
    const Eigen::Matrix<double, 15, 1> d = kStep * Eigen::Matrix<double, 15, 1>::Unit(k);
    by_state.col(k) = difference(propagated(moved(from, d), imu), propagated(moved(from, -d), imu)) / (2 * kStep);
  }
  StateCovariance root = StateCovariance::Identity();
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < i; ++j) root(i, j) = 0.3 * std::sin(1 + 2.3 * i + 1.7 * j);
  const StateCovariance P = root * root.transpose();
  const StateCovariance noise = propagatedCovariance(from, imu, StateCovariance::Zero());
  const StateCovariance expected = by_state * P * by_state.transpose() + noise;
  EXPECT_LT((propagatedCovariance(from, imu, P) - expected).norm(), 1e-5 * expected.norm());
}

TEST(Propagation, CovarianceGainsTheNoiseOfTheSamples) {
  const Preintegration imu = constantReadings({0.3, -0.5, 0.8}, {1, -2, 9}, {});
  InertialState from;
  from.T_w_b.q = expRotation({0.2, -0.6, 0.4});
  const StateCovariance noise = propagatedCovariance(from, imu, StateCovariance::Zero());
  const auto trace = [](const auto& m, int at) { return m.diagonal().template segment<3>(at).sum(); };
  EXPECT_NEAR(trace(noise, 0), trace(imu.covariance(), Preintegration::kPosition), 1e-12);
  EXPECT_NEAR(trace(noise, 3), trace(imu.covariance(), Preintegration::kTheta), 1e-12);
  EXPECT_NEAR(trace(noise, 6), trace(imu.covariance(), Preintegration::kVelocity), 1e-12);
  EXPECT_NEAR(noise(9, 9), imu.noise().gyro_walk * imu.noise().gyro_walk, 1e-15);
  EXPECT_NEAR(noise(14, 14), imu.noise().accel_walk * imu.noise().accel_walk, 1e-12);
}

}  // namespace
}  // namespace lintel
