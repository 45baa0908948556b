// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/Preintegration.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr std::int64_t kStart_ns = 1400000000000000000, kStep_ns = 5000000;

ImuBatch wavySamples(int count, const ImuBias& added = {}) {
  ImuBatch samples;
  for (int i = 0; i <= count; ++i) {
    const double t = 0.005 * i;
    samples.push_back({kStart_ns + i * kStep_ns,
                       Eigen::Vector3d(0.5 * std::sin(3 * t), 0.3 * std::cos(2 * t), 0.7) + added.gyro,
                       Eigen::Vector3d(2 * std::cos(t), -1 + t, 9.5 + std::sin(5 * t)) + added.accel});
  }
  return samples;
}

TEST(Preintegration, ConstantAccelerationWithoutRotationIsTheParabola) {
  Preintegration p({}, {});
  ImuBatch samples;
  for (int i = 0; i <= 200; ++i) samples.push_back({kStart_ns + i * kStep_ns, {0, 0, 0}, {1, 2, 3}});
  p.append(samples);
  EXPECT_NEAR(p.dt_s(), 1.0, 1e-12);
  EXPECT_TRUE(p.deltaV().isApprox(Eigen::Vector3d(1, 2, 3), 1e-12));
  EXPECT_TRUE(p.deltaP().isApprox(Eigen::Vector3d(0.5, 1, 1.5), 1e-12));
  EXPECT_NEAR(p.deltaR().angularDistance(Eigen::Quaterniond::Identity()), 0, 1e-12);
}

TEST(Preintegration, ConstantRateTurnsByRateTimesTime) {
  Preintegration p({}, {});
  ImuBatch samples;
  for (int i = 0; i <= 100; ++i) samples.push_back({kStart_ns + i * kStep_ns, {0, 0, 0.8}, {0, 0, 0}});
  p.append(samples);
  EXPECT_TRUE(logRotation(p.deltaR()).isApprox(Eigen::Vector3d(0, 0, 0.4), 1e-12));
}

TEST(Preintegration, TwoPartsMakeTheWhole) {
  const ImuBatch all = wavySamples(40);
  Preintegration whole({}, {}), first({}, {}), second({}, {});
  whole.append(all);
  first.append(ImuBatch(all.begin(), all.begin() + 21));
  second.append(ImuBatch(all.begin() + 20, all.end()));
  first.append(second);
  EXPECT_EQ(first.samples().size(), whole.samples().size());
  EXPECT_EQ(first.deltaP(), whole.deltaP());
  EXPECT_EQ(first.covariance(), whole.covariance());
}

TEST(Preintegration, RaisedNoiseIsThatOfAnIntegrationWithIt) {
  const ImuBatch samples = wavySamples(40);
  const ImuNoise low{1e-4, 1e-5, 1e-3, 1e-4}, least{1e-3, 1e-6, 5e-4, 1e-5}, both{1e-3, 1e-5, 1e-3, 1e-4};
  Preintegration raised({}, low), whole({}, both), kept({}, both);
  for (Preintegration* p : {&raised, &whole, &kept}) p->append(samples);
  raised.raiseNoise(least);
  EXPECT_EQ(raised.covariance(), whole.covariance());
  EXPECT_EQ(raised.deltaP(), whole.deltaP());
  kept.raiseNoise(low);
  EXPECT_EQ(kept.covariance(), whole.covariance()) << "nothing is lowered";
}

TEST(Preintegration, BiasJacobianIsTheDerivativeOfTheDeltas) {
  const ImuBatch samples = wavySamples(60);
  const ImuBias base{{0.02, -0.01, 0.03}, {0.1, 0.2, -0.1}};
  Preintegration p(base, {});
  p.append(samples);
  const double eps = 1e-6;
  for (int k = 0; k < 6; ++k) {
    ImuBias plus = base, minus = base;
    (k < 3 ? plus.gyro[k] : plus.accel[k - 3]) += eps;
    (k < 3 ? minus.gyro[k] : minus.accel[k - 3]) -= eps;
    Preintegration a(plus, {}), b(minus, {});
    a.append(samples);
    b.append(samples);
    Eigen::Matrix<double, 9, 1> numeric;
    numeric << logRotation(p.deltaR().conjugate() * a.deltaR()) - logRotation(p.deltaR().conjugate() * b.deltaR()),
        a.deltaV() - b.deltaV(), a.deltaP() - b.deltaP();
    numeric /= 2 * eps;
    EXPECT_LT((numeric - p.biasJacobian().col(k)).norm(), 1e-7) << "bias component " << k;
  }
}

TEST(Preintegration, FirstOrderCorrectionAgreesWithRepropagation) {
  Preintegration p({}, {});
  p.append(wavySamples(20));
  const ImuBias bias{{0.002, -0.001, 0.003}, {0.02, 0.01, -0.02}};
  const auto corrected = p.corrected(bias);
  p.repropagate(bias);
  EXPECT_LT(corrected.delta_R.angularDistance(p.deltaR()), 1e-6);
  EXPECT_LT((corrected.delta_v - p.deltaV()).norm(), 1e-5);
  EXPECT_LT((corrected.delta_p - p.deltaP()).norm(), 1e-6);
}

TEST(Preintegration, WhatWasNotMeasuredIsUncertain) {
  Preintegration measured({}, {}), bridged({}, {});
  ImuBatch samples = wavySamples(100);
  measured.append(samples);
  for (ImuSample& sample : samples) sample.bridged = true;
  bridged.append(samples);
  EXPECT_EQ(bridged.deltaP(), measured.deltaP());
  EXPECT_LT(std::sqrt(measured.covariance()(0, 0)), 0.001);
  EXPECT_NEAR(std::sqrt(bridged.covariance()(0, 0)), 0.1, 0.02);  // rad, after half a second
  EXPECT_GT(std::sqrt(bridged.covariance()(3, 3)), 0.4);          // m/s
}

TEST(Preintegration, WhatIsBeyondTheRangeIsUncertain) {
  ImuBatch samples = wavySamples(100);  // of 5 ms
  samples[50].gyro_open = 0.5, samples[50].accel_open = 2;
  Preintegration p({}, {});
  p.append(samples);
  EXPECT_NEAR(std::sqrt(p.covariance()(0, 0)), 0.5 * std::sqrt(0.01),
              0.002);                                               // rad, from the sample before to the next
  EXPECT_GT(std::sqrt(p.covariance()(3, 3)), 2 * std::sqrt(0.01));  // m/s
}

TEST(Preintegration, CorrelatedNoiseLeavesTheStartsAsItsCovarianceSays) {
  // of e(t) - e(0), <e(s) e(t)> = sigma^2 exp(-|t - s| / T), summed up over half-open steps of a four hundredth
  const double T = kAccelCorrelation_s, sigma = 0.03;
  for (const int samples : {1, 3, 20, 200, 600}) {
    ImuNoise without, with;
    with.accel_correlated = sigma;
    Preintegration a({}, without), b({}, with);
    ImuBatch batch;
    for (int i = 0; i <= samples; ++i) batch.push_back({kStart_ns + i * kStep_ns, {0, 0, 0}, {0, 0, 9.8}});
    a.append(batch);
    b.append(batch);
    constexpr int kSteps = 400;
    const double dt = b.dt_s(), h = dt / kSteps;
    double vv = 0, vp = 0, pp = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double s = (i + 0.5) * h, t = (j + 0.5) * h;
        const double c =
            sigma * sigma * h * h * (std::exp(-std::abs(t - s) / T) - std::exp(-t / T) - std::exp(-s / T) + 1);
        vv += c, vp += c * (dt - s), pp += c * (dt - s) * (dt - t);
      }
    const Preintegration::Matrix9 added = b.covariance() - a.covariance();
    for (int axis = 0; axis < 3; ++axis) {
      const int v = Preintegration::kVelocity + axis, p = Preintegration::kPosition + axis;
      EXPECT_NEAR(added(v, v) / vv, 1, 0.02) << samples;
      EXPECT_NEAR(added(v, p) / vp, 1, 0.02) << samples;
      EXPECT_NEAR(added(p, v) / vp, 1, 0.02) << samples;
      EXPECT_NEAR(added(p, p) / pp, 1, 0.02) << samples;
    }
    EXPECT_EQ(added.topRows<3>().norm(), 0) << "angles have none of it";
    EXPECT_TRUE(Eigen::LLT<Preintegration::Matrix9>(b.covariance()).info() == Eigen::Success) << samples;
  }
}

TEST(Preintegration, CovarianceOfPureNoiseIsThatOfARandomWalk) {
  ImuNoise noise;
  Preintegration p({}, noise);
  ImuBatch samples;
  for (int i = 0; i <= 200; ++i) samples.push_back({kStart_ns + i * kStep_ns, {0, 0, 0}, {0, 0, 0}});
  p.append(samples);
  const double t = 1.0;
  EXPECT_NEAR(p.covariance()(0, 0), noise.gyro_noise * noise.gyro_noise * t, 1e-12);
  EXPECT_NEAR(p.covariance()(3, 3), noise.accel_noise * noise.accel_noise * t, 1e-10);
  EXPECT_NEAR(p.covariance()(6, 6), noise.accel_noise * noise.accel_noise * t * t * t / 3, 1e-8);
}

TEST(Preintegration, OneStepHoldsTheWholeWhiteNoise) {
  // the integrals of white noise over dt: s^2 dt, s^2 dt^2 / 2, s^2 dt^3 / 3, of full rank
  ImuNoise noise;
  Preintegration p({}, noise);
  p.append(ImuBatch{{kStart_ns, {0, 0, 0}, {0, 0, 0}}, {kStart_ns + kStep_ns, {0, 0, 0}, {0, 0, 0}}});
  const double variance = noise.accel_noise * noise.accel_noise, dt = 0.005;
  const auto& C = p.covariance();
  EXPECT_NEAR(C(Preintegration::kVelocity, Preintegration::kVelocity) / (variance * dt), 1, 1e-9);
  EXPECT_NEAR(C(Preintegration::kVelocity, Preintegration::kPosition) / (variance * dt * dt / 2), 1, 1e-9);
  EXPECT_NEAR(C(Preintegration::kPosition, Preintegration::kPosition) / (variance * dt * dt * dt / 3), 1, 1e-9);
  EXPECT_EQ(C.llt().info(), Eigen::Success);
}

TEST(Preintegration, CovariancePropagationMatchesNumericNoiseJacobians) {
  // One disturbed sample pair at a time: the covariance must be the sum of the squared responses.
  const ImuBatch samples = wavySamples(12);
  ImuNoise noise;
  Preintegration p({}, noise);
  p.append(samples);
  Preintegration::Matrix9 expected = Preintegration::Matrix9::Zero();
  const double eps = 1e-6, dt = 0.005;
  for (std::size_t i = 1; i < samples.size(); ++i)
    for (int k = 0; k < 6; ++k) {
      // noise of one integration step: the same error at both of its ends, and only there
      Preintegration q({}, noise), rest({}, noise);
      q.append(ImuBatch(samples.begin(), samples.begin() + static_cast<long>(i)));
      ImuSample s0 = samples[i - 1], s1 = samples[i];
      for (ImuSample* s : {&s0, &s1}) (k < 3 ? s->gyro[k] : s->accel[k - 3]) += eps;
      rest.append({s0, s1});
      Preintegration tail({}, noise);
      tail.append(ImuBatch(samples.begin() + static_cast<long>(i), samples.end()));
      const auto compose = [](const Preintegration& a, const Preintegration& b, Eigen::Quaterniond& R,
                              Eigen::Vector3d& v, Eigen::Vector3d& x) {
        x = x + v * b.dt_s() + R * b.deltaP();
        v = v + R * b.deltaV();
        R = R * b.deltaR();
        (void)a;
      };
      Eigen::Quaterniond R = q.deltaR();
      Eigen::Vector3d v = q.deltaV(), x = q.deltaP();
      compose(q, rest, R, v, x);
      compose(q, tail, R, v, x);
      Eigen::Matrix<double, 9, 1> response;
      response << logRotation(p.deltaR().conjugate() * R), v - p.deltaV(), x - p.deltaP();
      response /= eps;
      const double sigma = (k < 3 ? noise.gyro_noise : noise.accel_noise) / std::sqrt(dt);
      expected += sigma * sigma * response * response.transpose();
    }
  EXPECT_LT((expected - p.covariance()).norm() / p.covariance().norm(), 1e-4);
}

}  // namespace
}  // namespace lintel
