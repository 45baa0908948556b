// SPDX-License-Identifier: BSD-3-Clause
#include "TwoViewMotion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// 60 points at depths from 2 to 8 seen by a camera that turns by `R_c1_c0` and moves by `p_c1_c0`.
std::vector<TwoViewPair> pairsOf(const Eigen::Quaterniond& R_c1_c0, const Eigen::Vector3d& p_c1_c0) {
  std::vector<TwoViewPair> pairs;
  for (int i = 0; i < 60; ++i) {
    const double depth = 2 + 6 * std::fmod(i * 0.618, 1.0);
    const Eigen::Vector3d p_c0(depth * (-0.7 + 0.023 * i), depth * (0.45 * std::sin(1.7 * i)), depth);
    const Eigen::Vector3d p_c1 = R_c1_c0 * p_c0 + p_c1_c0;
    pairs.push_back({p_c0 / p_c0.z(), p_c1 / p_c1.z()});
  }
  return pairs;
}

const Eigen::Matrix3d kLooseRotation = Eigen::Matrix3d::Identity() / (5e-3 * 5e-3);

TEST(TwoViewMotion, findsDirectionAndRotationError) {
  const Eigen::Quaterniond truth = expRotation({0.03, -0.02, 0.01});
  const Eigen::Vector3d error(3e-3, -2e-3, 4e-3), p(0.1, 0.02, -0.05);
  const TwoViewMotion motion = twoViewMotion(pairsOf(truth, p), expRotation(-error) * truth, kLooseRotation, {});
  EXPECT_EQ(motion.inliers, 60);
  EXPECT_LT((motion.delta - error).norm(), 2e-4);
  EXPECT_LT(motion.direction.cross(p.normalized()).norm(), 0.03);
}

TEST(TwoViewMotion, rejectsPointsOffTheirEpipolarLine) {
  const Eigen::Vector3d p(0.2, 0, 0);
  std::vector<TwoViewPair> pairs = pairsOf(Eigen::Quaterniond::Identity(), p);
  for (std::size_t i = 0; i < pairs.size(); i += 4) pairs[i].x1.y() += (i % 8 == 0 ? 5.0 : -7.0) / 460;
  const TwoViewMotion motion = twoViewMotion(pairs, Eigen::Quaterniond::Identity(), kLooseRotation, {});
  for (std::size_t i = 0; i < pairs.size(); ++i) EXPECT_EQ(static_cast<bool>(motion.inlier[i]), i % 4 != 0) << i;
}

TEST(TwoViewMotion, keepsEverythingAtRestAndStillSeesTheRotation) {
  const Eigen::Vector3d error(2e-3, 1e-3, -3e-3);
  const TwoViewMotion motion = twoViewMotion(pairsOf(expRotation(error), Eigen::Vector3d::Zero()),
                                             Eigen::Quaterniond::Identity(), kLooseRotation, {});
  EXPECT_EQ(motion.inliers, 60);
  EXPECT_LT((motion.delta - error).norm(), 2e-4);
}

TEST(TwoViewMotion, estimatesNothingFromFewPoints) {
  const TwoViewMotion motion =
      twoViewMotion(std::vector<TwoViewPair>(5), Eigen::Quaterniond::Identity(), kLooseRotation, {});
  EXPECT_EQ(motion.inliers, 5);
  EXPECT_EQ(motion.delta.norm(), 0);
}

}  // namespace
}  // namespace lintel
