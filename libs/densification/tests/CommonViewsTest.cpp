// SPDX-License-Identifier: BSD-3-Clause
#include "CommonViews.h"

#include <gtest/gtest.h>

#include <set>

#include "TestFlight.h"

namespace lintel {
namespace {

class CommonViewsTest : public testing::Test {
 protected:
  std::vector<CommonViews> find(std::size_t most) {
    const KeyframeCameras cameras(flight_.material);
    views_.clear();
    for (const RetiredKeyframe& k : flight_.material.keyframes)
      views_.emplace_back(cameras, k.id, flight_.edges[k.t_ns]);
    return findCommonViews(SeenPoints(flight_.material, views_), most, views_);
  }

  test::TestFlight flight_{12};
  std::vector<SegmentView> views_;
};

TEST_F(CommonViewsTest, ViewsOfTheSamePointsAreChosenApart) {
  const std::vector<CommonViews> common = find(5);
  ASSERT_EQ(common.size(), 12U);
  for (std::size_t v = 0; v < 12; ++v) {
    EXPECT_EQ(common[v].all.size(), 12U);
    EXPECT_TRUE(std::is_sorted(common[v].all.begin(), common[v].all.end()));
    ASSERT_EQ(common[v].chosen.size(), 5U);
    EXPECT_EQ(std::set<std::size_t>(common[v].chosen.begin(), common[v].chosen.end()).count(v), 0U);
    for (std::size_t other = 0; other < 12; ++other)
      EXPECT_LE((views_[other].p_w_c - views_[v].p_w_c).norm(),
                (views_[common[v].chosen[0]].p_w_c - views_[v].p_w_c).norm())
          << "the farthest first";
  }
}

TEST_F(CommonViewsTest, ViewsOfOtherPointsAreNotCommon) {
  for (PointRecord& point : flight_.material.points) {
    const bool early = point.id % 2 == 0;
    point.views.erase(std::remove_if(point.views.begin(), point.views.end(),
                                     [&](const PointView& v) { return (v.keyframe < 6) != early; }),
                      point.views.end());
  }
  const std::vector<CommonViews> common = find(20);
  EXPECT_EQ(common[0].all, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(common[9].all, (std::vector<std::size_t>{6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(common[9].chosen.size(), 5U);
}

TEST_F(CommonViewsTest, AViewOfFewPointsHasNone) {
  for (PointRecord& point : flight_.material.points)
    if (point.id >= 5) point.views.erase(point.views.begin());
  EXPECT_TRUE(find(20)[0].chosen.empty());
}

TEST_F(CommonViewsTest, DepthsAreThoseOfThePoints) {
  find(5);
  for (const SegmentView& view : views_) {
    EXPECT_GT(view.near_m, 1);
    EXPECT_LT(view.near_m, 2.2);
    EXPECT_GT(view.far_m, 11);
    EXPECT_LT(view.far_m, 16);
  }
}

}  // namespace
}  // namespace lintel
