// SPDX-License-Identifier: BSD-3-Clause
#include "WordIndex.h"

#include <gtest/gtest.h>

#include "SyntheticPlaces.h"

namespace lintel {
namespace {

TEST(WordIndex, TheViewWithTheSameFeaturesScoresHighest) {
  test::SyntheticPlaces world;
  WordIndex index;
  std::vector<PlaceView> views(10);
  for (PlaceView& view : views) {
    for (int i = 0; i < 50; ++i)
      view.features.push_back({Eigen::Vector2f::Zero(), PlaceFeature::kNoTrack, 0, world.anyLook()});
    index.add(view);
  }
  PlaceView query;
  for (std::size_t i = 0; i < 50; ++i) {
    query.features.push_back(views[i < 20 ? 3 : 7].features[i]);  // 20 of one, 30 of another
    query.features.back().descriptor[0] ^= 0x10010;               // two bits are different
  }
  const std::vector<float> scores = index.scores(query, views.size());
  ASSERT_EQ(scores.size(), 10u);
  EXPECT_EQ(std::max_element(scores.begin(), scores.end()) - scores.begin(), 7);
  EXPECT_GT(scores[3], 5 * scores[0]);
  EXPECT_EQ(index.scores(query, 5).size(), 5u) << "later views are left out";
}

}  // namespace
}  // namespace lintel
