// SPDX-License-Identifier: BSD-3-Clause
#include "CanonicalPose.h"

#include <gtest/gtest.h>

#include <random>

namespace lintel {
namespace {

void expectSameBits(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
  EXPECT_EQ(a.p, b.p);
}

Pose throughAMatrix(const Pose& pose) { return {Eigen::Quaterniond(pose.R()), pose.p}; }

TEST(CanonicalPoseTest, SurvivesNoiseOfStoring) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    const Pose pose = canonicalPose({q.normalized(), {normal(random), 1, 2}});
    Pose stored = throughAMatrix(pose);
    for (int k = 0; k < 4; ++k) stored.q.coeffs()[k] += 1e-13 * normal(random) / 4;
    expectSameBits(canonicalPose(stored), pose);
    stored.q.coeffs() *= -1;
    expectSameBits(canonicalPose(stored), pose);
  }
}

TEST(CanonicalPoseTest, SurvivesForRotationsWithEqualComponents) {
  const double h = std::sqrt(0.5);
  for (const Eigen::Quaterniond& q :
       {Eigen::Quaterniond(1, 0, 0, 0), Eigen::Quaterniond(h, h, 0, 0), Eigen::Quaterniond(h, 0, -h, 0),
        Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), Eigen::Quaterniond(0, 0, 0, 1), Eigen::Quaterniond(0, h, 0, h)}) {
    const Pose pose = canonicalPose({q, Eigen::Vector3d::Zero()});
    for (const double noise : {-2e-16, 0.0, 2e-16}) {
      Pose stored = throughAMatrix(pose);
      stored.q.coeffs()[1] += noise;
      stored.q.coeffs()[3] -= noise;
      expectSameBits(canonicalPose(stored), pose);
    }
  }
}

TEST(CanonicalPoseTest, ChangesLittle) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.3, -0.2, 0.5, 0.1).normalized();
  EXPECT_LT(canonicalPose({q, {1, 2, 3}}).q.angularDistance(q), 4e-12);
  EXPECT_EQ(canonicalPose({q, {1, 2, 3}}).p, Eigen::Vector3d(1, 2, 3));
}

}  // namespace
}  // namespace lintel
