// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/StampJitter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// A body that turns to and fro about two axes and swings.
InertialState truthAt(double t_s) {
  InertialState state;
  state.T_w_b.q = expRotation({0, 0, 0.6 * std::sin(1.3 * t_s)}) * expRotation({0.4 * std::sin(0.9 * t_s), 0, 0});
  state.T_w_b.p = {0.8 * std::sin(t_s), 0.5 * std::cos(1.4 * t_s), 0.2 * std::sin(2 * t_s)};
  state.v_w_b = {0.8 * std::cos(t_s), -0.7 * std::sin(1.4 * t_s), 0.4 * std::cos(2 * t_s)};
  return state;
}

ImuSample sampleAt(double t_s) {
  constexpr double kStep = 1e-5;
  const InertialState before = truthAt(t_s - kStep), here = truthAt(t_s), after = truthAt(t_s + kStep);
  const Eigen::Vector3d a_w = (after.v_w_b - before.v_w_b) / (2 * kStep);
  return {std::llround(1e9 * t_s), logRotation(before.T_w_b.q.conjugate() * after.T_w_b.q) / (2 * kStep),
          here.T_w_b.q.conjugate() * (a_w - gravityW())};
}

Preintegration between(double from_s, double to_s, double gain = 1) {
  ImuBatch samples;
  const int n = static_cast<int>(std::lround((to_s - from_s) / 0.0025));
  for (int i = 0; i <= n; ++i) {
    samples.push_back(sampleAt(from_s + (to_s - from_s) * i / n));
    samples.back().gyro *= gain;
  }
  Preintegration imu({}, {});
  imu.append(samples);
  return imu;
}

/// What is estimated of 100 intervals of 0.1 s: stamps off by `jitter_s`, attitudes wrong by `error_rad`.
double estimated(double jitter_s, double error_rad, double gain = 1) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  StampJitter jitter;
  InertialState from = truthAt(0);
  for (int k = 1; k <= 100; ++k) {
    InertialState to = truthAt(0.1 * k + jitter_s * normal(random));
    to.T_w_b.q = to.T_w_b.q * expRotation(error_rad * Eigen::Vector3d(normal(random), normal(random), normal(random)));
    jitter.add(from, to, between(0.1 * (k - 1), 0.1 * k, gain));
    from = to;
  }
  return jitter.sigma_s();
}

TEST(StampJitter, ErrorsAlongTheAxisOfTheTurnAreThoseOfTheStamps) {
  EXPECT_NEAR(estimated(0.002, 1e-4), 0.002, 3e-4);
  EXPECT_NEAR(estimated(0.005, 2e-4), 0.005, 8e-4);
}

TEST(StampJitter, ErrorsInAllDirectionsAreNot) {
  EXPECT_EQ(estimated(0, 0), 0);
  EXPECT_EQ(estimated(0, 2e-4), 0);
  EXPECT_EQ(estimated(0, 2e-3), 0);
}

TEST(StampJitter, AGainOfTheGyroscopeIsNot) { EXPECT_EQ(estimated(0, 2e-4, 1.02), 0); }

TEST(StampJitter, WhatIsTooSmallToMatterIsNotCounted) { EXPECT_EQ(estimated(2e-4, 1e-5), 0); }

TEST(StampJitter, ABodyThatDoesNotTurnSaysNothing) {
  ImuBatch samples;
  for (int i = 0; i <= 20; ++i) samples.push_back({i * 5'000'000LL, Eigen::Vector3d::Zero(), -gravityW()});
  Preintegration imu({}, {});
  imu.append(samples);
  StampJitter jitter;
  InertialState wrong;
  wrong.T_w_b.q = expRotation({0.1, 0, 0});
  for (int k = 0; k < 50; ++k) jitter.add({}, wrong, imu);
  EXPECT_EQ(jitter.sigma_s(), 0);
}

/// ImuFactor's residuals, not weighted.
Eigen::Matrix<double, 9, 1> residual(const InertialState& from, const InertialState& to, const Preintegration& imu) {
  const InertialState expected = propagated(from, imu);
  const Eigen::Quaterniond R_b_w = from.T_w_b.q.conjugate();
  Eigen::Matrix<double, 9, 1> r;
  r << logRotation(expected.T_w_b.q.conjugate() * to.T_w_b.q), R_b_w * (to.v_w_b - expected.v_w_b),
      R_b_w * (to.T_w_b.p - expected.T_w_b.p);
  return r;
}

TEST(StampJitter, TheCovarianceIsThatOfOtherTimes) {
  const double start_s = 0.7, end_s = 1.1, step_s = 1e-5, sigma_s = 0.003;
  Preintegration imu = between(start_s, end_s);
  const auto at = [&](double i, double j) { return residual(truthAt(start_s + i), truthAt(end_s + j), imu); };
  Eigen::Matrix<double, 9, 2> by_times;
  by_times << (at(step_s, 0) - at(-step_s, 0)) / (2 * step_s), (at(0, step_s) - at(0, -step_s)) / (2 * step_s);
  const Preintegration::Matrix9 before = imu.covariance(),
                                expected = sigma_s * sigma_s * by_times * by_times.transpose();
  countStampJitter(sigma_s, truthAt(start_s), truthAt(end_s), imu);
  EXPECT_LT((imu.covariance() - before - expected).norm(), 1e-3 * expected.norm());
  EXPECT_EQ(imu.stampSigma(), sigma_s);
  countStampJitter(0, truthAt(start_s), truthAt(end_s), imu);
  EXPECT_EQ(imu.covariance(), before);
}

}  // namespace
}  // namespace lintel
