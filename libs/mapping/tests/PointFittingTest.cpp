// SPDX-License-Identifier: BSD-3-Clause
#include "PointFitting.h"

#include <gtest/gtest.h>

#include "Evidence.h"
#include "TestMaterial.h"

namespace lintel {
namespace {

using namespace test;

class PointFittingTest : public testing::Test {
 protected:
  bool fit(PointRecord& point) const { return fitPoint(KeyframeCameras(material_), {}, point); }
  MapMaterial material_ = materialAlongX();
};

TEST_F(PointFittingTest, ExactViewsGiveThePoint) {
  PointRecord point = pointOf(material_, 1, {0.7, 0.2, 5});
  ASSERT_TRUE(fit(point));
  EXPECT_LT((point.p_w - Eigen::Vector3d(0.7, 0.2, 5)).norm(), 1e-6);
  EXPECT_LT(point.error_px, 1e-5);
}

TEST_F(PointFittingTest, SigmaIsThatOfTheParallax) {
  PointRecord point = pointOf(material_, 1, {0.25, 0, 4}, 0, 1);
  ASSERT_TRUE(fit(point));
  const double expected = std::sqrt(2) * 16.0 / (458 * 0.5);  // z^2 sqrt(2 views) / (f b)
  EXPECT_NEAR(point.sigma_distance_m, expected, 0.15 * expected);
}

TEST_F(PointFittingTest, AViewOfSomethingElseIsAnOutlier) {
  PointRecord point = pointOf(material_, 1, {0.7, 0.2, 5}, 0, 4);
  point.views[1].px.y() += 25;
  ASSERT_TRUE(fit(point));
  EXPECT_LT((point.p_w - Eigen::Vector3d(0.7, 0.2, 5)).norm(), 1e-2);
  EXPECT_FALSE(point.views[1].inlier);
  EXPECT_TRUE(point.views[0].inlier && point.views[4].inlier);
}

TEST(Evidence, ThinningOutKeepsTheFirstTheLastAndWhatIsBetweenEvenly) {
  std::vector<int> all{0, 1, 2, 3, 4, 5, 6, 7, 8};
  std::vector<int> few = all;
  thinOut(few, 5);
  EXPECT_EQ(few, (std::vector<int>{0, 2, 4, 6, 8}));
  thinOut(few, 2);
  EXPECT_EQ(few, (std::vector<int>{0, 8}));
  few = all;
  thinOut(few, 9);
  EXPECT_EQ(few, all);
  thinOut(few, 0);
  EXPECT_EQ(few, all) << "no limit";
}

/// A minute at one place: it is fitted to some of the views, and all are judged.
TEST(PointFitting, OfThousandsOfViewsEachIsJudged) {
  const MapMaterial material = materialAlongX(2000, 0.001);
  PointRecord point = pointOf(material, 1, {0.7, 0.2, 5}, 0, 1999);
  for (std::size_t i = 100; i < point.views.size(); i += 100) point.views[i].px.y() += 25;
  ASSERT_TRUE(fitPoint(KeyframeCameras(material), {}, point));
  EXPECT_LT((point.p_w - Eigen::Vector3d(0.7, 0.2, 5)).norm(), 1e-3);
  EXPECT_EQ(inliersOf(point), 1981);
}

TEST_F(PointFittingTest, WithoutParallaxOrAtInfinityThereIsNoPoint) {
  PointRecord once = pointOf(material_, 1, {0.7, 0.2, 5}, 1, 1), far = pointOf(material_, 2, {0, 0, 5000});
  EXPECT_FALSE(fit(once));
  EXPECT_FALSE(fit(far));
}

}  // namespace
}  // namespace lintel
