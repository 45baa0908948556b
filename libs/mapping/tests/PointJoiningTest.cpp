// SPDX-License-Identifier: BSD-3-Clause
#include "PointJoining.h"

#include <gtest/gtest.h>

#include "TestMaterial.h"

namespace lintel {
namespace {

using namespace test;

/// Points seen by keyframes 0 to 3, and again, as other tracks, by 5 to 8.
class PointJoiningTest : public testing::Test {
 protected:
  int join(const std::vector<PointJoin>& joins, double most_px) {
    const KeyframeCameras cameras(material_);
    for (PointRecord& point : points_) EXPECT_TRUE(fitPoint(cameras, {}, point));
    return joinPoints(cameras, {}, joins, most_px, 1, points_);
  }

  MapMaterial material_ = materialAlongX(9);
  const Eigen::Vector3d p_w_{2, 0.3, 4};
  std::vector<PointRecord> points_{pointOf(material_, 1, p_w_, 0, 3), pointOf(material_, 2, p_w_, 5, 8)};
};

TEST_F(PointJoiningTest, TwoVisitsOfAPointAreOnePointBesideTheTwo) {
  EXPECT_EQ(join({{1, 2}}, 3), 1);
  ASSERT_EQ(points_.size(), 3u);
  EXPECT_EQ(points_[2].views.size(), 8u);
  EXPECT_LT((points_[2].p_w - p_w_).norm(), 1e-6);
  EXPECT_DOUBLE_EQ(points_[2].extra_sigma_px, 1);
  EXPECT_EQ(points_[0].views.size(), 4u);
  EXPECT_EQ(points_[0].extra_sigma_px, 0);
}

TEST_F(PointJoiningTest, WhatIsFarApartHoldsLessAndIsReleasedInTheEnd) {
  points_[1] = pointOf(material_, 2, p_w_ + Eigen::Vector3d(0, 0.1, 0), 5, 8);  // some 11 px
  EXPECT_EQ(join({{1, 2}}, 30), 1);
  ASSERT_EQ(points_.size(), 3u);
  EXPECT_GT(points_[2].extra_sigma_px, 3);
  points_.pop_back();
  EXPECT_EQ(join({{1, 2}}, 3), 0);
  EXPECT_EQ(points_.size(), 2u);
}

TEST_F(PointJoiningTest, OfContradictingJoinsTheOneWithMoreVotesHolds) {
  points_.push_back(pointOf(material_, 3, p_w_ + Eigen::Vector3d(0, 0.01, 0), 5, 8));
  EXPECT_EQ(join({{1, 3, 1}, {1, 2, 4}}, 30), 1) << "one keyframe saw 2 and 3";
  ASSERT_EQ(points_.size(), 4u);
  EXPECT_LT((points_[3].p_w - p_w_).norm(), 1e-6);
}

TEST_F(PointJoiningTest, JoinsOfAbsentTracksAndNoJoinsChangeNothing) {
  EXPECT_EQ(join({}, 3), 0);
  EXPECT_EQ(join({{1, 77}, {78, 2}}, 3), 0);
  EXPECT_EQ(points_.size(), 2u);
}

TEST_F(PointJoiningTest, ATrackThatWasMergedIsFoundUnderItsOldName) {
  points_[1].joined = {9};
  EXPECT_EQ(join({{1, 9}}, 3), 1);
}

}  // namespace
}  // namespace lintel
