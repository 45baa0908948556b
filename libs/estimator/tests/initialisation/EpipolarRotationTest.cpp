// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/EpipolarRotation.h"

#include <gtest/gtest.h>

#include <random>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

constexpr double kWidth_rad = 0.004;
const Eigen::Vector3d kTurn(0.05, -0.08, 0.03), kBias(0.02, 0.01, -0.03);

/// Two views of thirty points, by a body that moves by `t` and turns by kTurn. The gyroscope is off by kBias for 0.3 s.
FramePair pairFor(const Eigen::Vector3d& t, double noise_rad) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> place(-1, 1);
  std::normal_distribution<double> noise(0, noise_rad);
  const auto noisy = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d ray = p.normalized() + Eigen::Vector3d(noise(engine), noise(engine), noise(engine));
    return Eigen::Vector3d(ray.normalized());
  };
  FramePair pair;
  const Eigen::Quaterniond R = expRotation(kTurn);
  pair.d_theta_d_bias = -0.3 * Eigen::Matrix3d::Identity();
  pair.R_a_b = R * expRotation(0.3 * kBias);
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d p(2 * place(engine), 2 * place(engine), 5 + 2 * place(engine));
    pair.rays.emplace_back(noisy(p), noisy(R.conjugate() * (p - t)));
  }
  return pair;
}

TEST(EpipolarRotation, ExactRaysHaveNoCostAtTheTrueBiasWhereverItMoves) {
  for (const Eigen::Vector3d& t :
       {Eigen::Vector3d(0.3, 0, 0), Eigen::Vector3d(0, -0.3, 0.1), Eigen::Vector3d(0, 0.02, 0.3)}) {
    std::vector<FramePair> pairs{pairFor(t, 0)};
    const EpipolarSystem system = epipolarSystem(pairs, kBias, kWidth_rad);
    EXPECT_LT(system.cost, 1e-12) << t.transpose();
    EXPECT_GT(epipolarSystem(pairs, Eigen::Vector3d::Zero(), kWidth_rad).cost, 1e-7) << t.transpose();
  }
}

TEST(EpipolarRotation, TheGradientIsThatOfTheCost) {
  std::vector<FramePair> pairs{pairFor({0.3, 0.1, 0.05}, 1e-3)};
  const Eigen::Vector3d bias = kBias + Eigen::Vector3d(0.004, -0.006, 0.005);
  const EpipolarSystem system = epipolarSystem(pairs, bias, kWidth_rad);
  constexpr double kStep = 1e-4;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    const double change =
        epipolarSystem(pairs, bias + step, kWidth_rad).cost - epipolarSystem(pairs, bias - step, kWidth_rad).cost;
    EXPECT_NEAR(2 * system.b(k), change / (2 * kStep), 0.01 * system.b.head<3>().norm()) << k;
  }
}

TEST(EpipolarRotation, TheGradientByTheReadoutIsThatOfTheCost) {
  FramePair pair = pairFor({0.3, 0.1, 0.05}, 1e-3);
  for (std::size_t i = 0; i < pair.rays.size(); ++i) {
    const Eigen::Vector3d omega(0.3, static_cast<double>(i % 5) - 2, 0.5);
    pair.d_rays_d_readout.emplace_back(omega.cross(pair.rays[i].first), -omega.cross(pair.rays[i].second));
  }
  std::vector<FramePair> pairs{pair};
  const EpipolarSystem system = epipolarSystem(pairs, kBias, kWidth_rad);
  constexpr double kStep_s = 1e-4;
  double change = 0;
  for (const double sign : {1.0, -1.0}) {
    std::vector<FramePair> moved = pairs;
    for (std::size_t i = 0; i < pair.rays.size(); ++i) {
      moved[0].rays[i].first += sign * kStep_s * pair.d_rays_d_readout[i].first;
      moved[0].rays[i].second += sign * kStep_s * pair.d_rays_d_readout[i].second;
    }
    change += sign * epipolarSystem(moved, kBias, kWidth_rad).cost;
  }
  EXPECT_NEAR(2 * system.b(3), change / (2 * kStep_s), 0.01 * std::abs(system.b(3)));
}

}  // namespace
}  // namespace lintel
