// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/DriftSpreading.h"

#include <gtest/gtest.h>

#include "TestMaterial.h"

namespace lintel {
namespace {

using namespace test;

/// 101 keyframes 0.5 m apart along x; the odometry turns by a tenth of a degree in each step. The last ten show the
/// place of the first ten again, from 1 m above.
class DriftSpreadingTest : public testing::Test {
 protected:
  static constexpr std::size_t kFrames = 101;

  static Pose truth(std::size_t k) {
    const double s = k < 50 ? static_cast<double>(k) : static_cast<double>(100 - k);
    return {Eigen::Quaterniond::Identity(), {0.5 * s, 0, k < 50 ? 0.0 : 1.0}};
  }

  explicit DriftSpreadingTest(double turn_rad = 0.0017) {
    Pose drifted;
    for (std::size_t k = 0; k < kFrames; ++k) {
      RetiredKeyframe& keyframe = material_.keyframes[k];
      if (k > 0) {
        Pose step = truth(k - 1).inverse() * truth(k);
        step.q = expRotation({0, 0, turn_rad});
        drifted = drifted * step;
        keyframe.imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
      }
      keyframe.T_w_b = drifted;
      keyframe.v_w_b = drifted.q * Eigen::Vector3d(5, 0, 0);
      material_.trajectory.emplace_back(keyframe.t_ns, drifted);
      if (k > 90) sightings_.push_back({timeOf(100 - k), timeOf(k), drifted, truth(k)});
    }
    material_.pieces = separatePieces(material_);
  }
  std::int64_t timeOf(std::size_t k) const { return material_.keyframes[k].t_ns; }
  double error(std::size_t k) const { return (material_.keyframes[k].T_w_b.p - truth(k).p).norm(); }

  MapMaterial material_ = materialAlongX(kFrames);
  std::vector<PlaceSighting> sightings_;
};

TEST_F(DriftSpreadingTest, TheWayBetweenTakesTheDrift) {
  EXPECT_GT(error(50), 1.0);
  EXPECT_GT(error(100), 0.9);
  PointRecord point;
  point.p_w = material_.keyframes[100].T_w_b.p;
  point.views = {{100, {}, true}};
  material_.points = {point};
  const Pose before = material_.keyframes[100].T_w_b;
  ASSERT_TRUE(spreadDrift(sightings_, material_));
  EXPECT_EQ(error(0), 0) << "the first is held";
  for (std::size_t k = 91; k < kFrames; ++k) EXPECT_LT(error(k), 0.1) << k;
  EXPECT_LT((material_.points[0].p_w - material_.keyframes[100].T_w_b.p).norm(), 1e-9) << "moves with its keyframe";
  EXPECT_EQ(material_.trajectory[100].second.p, material_.keyframes[100].T_w_b.p);
  EXPECT_GT(before.q.angularDistance(material_.keyframes[100].T_w_b.q), 0.1);
}

TEST_F(DriftSpreadingTest, AFalseSightingBendsNothing) {
  sightings_.push_back({timeOf(20), timeOf(60), truth(60), {Eigen::Quaterniond::Identity(), {15, 20, 0}}});
  ASSERT_TRUE(spreadDrift(sightings_, material_));
  for (std::size_t k = 91; k < kFrames; ++k) EXPECT_LT(error(k), 0.1) << k;
  for (std::size_t k = 1; k < kFrames; ++k)
    EXPECT_LT((material_.keyframes[k].T_w_b.p - material_.keyframes[k - 1].T_w_b.p).norm(), k == 50 ? 1.5 : 0.6) << k;
}

TEST_F(DriftSpreadingTest, ABlindStretchTakesNearlyAllOfIt) {
  const Pose jump{Eigen::Quaterniond::Identity(), {0, 1, 0}};
  for (std::size_t k = 0; k < kFrames; ++k) material_.keyframes[k].T_w_b = k < 60 ? truth(k) : jump * truth(k);
  for (std::size_t k = 56; k < 61; ++k) material_.keyframes[k].blind = true;
  for (std::size_t i = 0; i < sightings_.size(); ++i) sightings_[i].T_w_c0 = material_.keyframes[91 + i].T_w_b;
  ASSERT_TRUE(spreadDrift(sightings_, material_));
  for (std::size_t k = 0; k < kFrames; ++k) {
    if (k < 55 || k >= 60) {
      EXPECT_LT(error(k), 0.15) << k;
    }
  }
}

TEST_F(DriftSpreadingTest, SmallDriftIsLeftToTheAdjustment) {
  for (PlaceSighting& seen : sightings_)
    seen.T_w_c0 = {Eigen::Quaterniond::Identity(), seen.T_w_c1.p + Eigen::Vector3d(0.08, 0, 0)};
  const MapMaterial before = material_;
  EXPECT_FALSE(spreadDrift(sightings_, material_));
  EXPECT_EQ(material_.keyframes[100].T_w_b.p, before.keyframes[100].T_w_b.p);
  EXPECT_FALSE(spreadDrift({}, material_));
}

}  // namespace
}  // namespace lintel
