// SPDX-License-Identifier: BSD-3-Clause
#include "Resection.h"

#include <gtest/gtest.h>

#include <random>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// A camera that sees points 2 to 8 m away, of which a part is matched to wrong directions.
class ResectionTest : public testing::Test {
 protected:
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random_() % 100000) / 1e5; }

  std::vector<Sighting> sightings(int right, int wrong) {
    std::vector<Sighting> all;
    for (int i = 0; i < right + wrong; ++i) {
      const Eigen::Vector3d ray = Eigen::Vector3d(between(-0.7, 0.7), between(-0.5, 0.5), 1).normalized();
      const Eigen::Vector3d other = Eigen::Vector3d(between(-0.7, 0.7), between(-0.5, 0.5), 1).normalized();
      all.push_back({truth_ * Eigen::Vector3d(between(2, 8) * ray), i < right ? ray : other});
    }
    return all;
  }

  std::mt19937 random_{7};
  const Pose truth_{expRotation({-1.7, 0.2, 0.4}), {3, -2, 1.5}};
  ResectionParams params_;
};

TEST_F(ResectionTest, FindsThePoseAmongWrongSightings) {
  const std::vector<Sighting> all = sightings(30, 60);
  // the odometry's roll and pitch are off by half a degree; its yaw is unknown
  const Eigen::Quaterniond R = expRotation({0, 0, 2.0}) * truth_.q * expRotation({0.006, -0.005, 0.004});
  const auto found = resect(all, R, params_);
  ASSERT_TRUE(found);
  EXPECT_LT((found->T_w_c.p - truth_.p).norm(), 1e-3);
  EXPECT_LT(logRotation(found->T_w_c.q.conjugate() * truth_.q).norm(), 1e-4);
  EXPECT_GE(found->inliers.size(), 30u);
  EXPECT_LE(found->inliers.size(), 32u);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_EQ(found->inliers[i], i);
}

TEST_F(ResectionTest, WrongSightingsAloneAgreeOnNothing) {
  const auto found = resect(sightings(0, 90), truth_.q, params_);
  EXPECT_LT(found ? found->inliers.size() : 0, 8u);
}

TEST_F(ResectionTest, PointsOnOneWallAreEnough) {
  std::vector<Sighting> all = sightings(20, 0);
  for (Sighting& s : all) s.p_w = truth_ * Eigen::Vector3d(4 / s.bearing_c.z() * s.bearing_c);
  const auto found = resect(all, truth_.q, params_);
  ASSERT_TRUE(found);
  EXPECT_LT((found->T_w_c.p - truth_.p).norm(), 1e-3);
}

TEST_F(ResectionTest, DegenerateSightingsGiveNoPose) {
  EXPECT_FALSE(resect({}, truth_.q, params_));
  EXPECT_FALSE(resect(sightings(3, 0), truth_.q, params_)) << "fewer than four";
  std::vector<Sighting> same(20, sightings(1, 0).front());
  const auto found = resect(same, truth_.q, params_);
  EXPECT_TRUE(!found || found->T_w_c.p.allFinite());
}

TEST_F(ResectionTest, TheSameSightingsGiveTheSamePose) {
  const std::vector<Sighting> all = sightings(30, 60);
  const auto a = resect(all, truth_.q, params_), b = resect(all, truth_.q, params_);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->T_w_c.p, b->T_w_c.p);
}

}  // namespace
}  // namespace lintel
