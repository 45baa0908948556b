// SPDX-License-Identifier: BSD-3-Clause
#include "../src/KeyframeClusters.h"

#include <gtest/gtest.h>

#include <set>

namespace lintel {
namespace {

/// Keyframes 0.1 s apart, each with the IMU since the one before.
std::vector<RetiredKeyframe> keyframes(std::size_t n) {
  std::vector<RetiredKeyframe> result(n);
  for (std::size_t k = 0; k < n; ++k) {
    result[k].id = k;
    result[k].t_ns = static_cast<std::int64_t>(k) * 100'000'000;
    if (k == 0) continue;
    auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
    imu->append({{result[k - 1].t_ns, {}, {}}, {result[k].t_ns, {}, {}}});
    result[k].imu = imu;
  }
  return result;
}

std::vector<std::size_t> mains(const std::vector<Anchors>& anchors) {
  std::vector<std::size_t> result;
  result.reserve(anchors.size());
  for (const Anchors& a : anchors) result.push_back(a.main);
  return result;
}

TEST(KeyframeClusters, KeyframesHangOnTheNearerAnchor) {
  const std::vector<Anchors> anchors = anchorsOf(keyframes(8), 0.3);
  EXPECT_EQ(mains(anchors), (std::vector<std::size_t>{0, 0, 3, 3, 3, 6, 6, 7}));
  EXPECT_EQ(anchors[1].other, 3u);
  EXPECT_EQ(anchors[5].other, 3u);
  EXPECT_EQ(anchors[6].other, 6u);
}

TEST(KeyframeClusters, WithoutAnIntervalAllAreAnchors) {
  EXPECT_EQ(mains(anchorsOf(keyframes(4), 0)), (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(KeyframeClusters, NothingHangsOnAnotherRun) {
  auto all = keyframes(8);
  all[4].imu = nullptr;  // a new start
  EXPECT_EQ(mains(anchorsOf(all, 1)), (std::vector<std::size_t>{0, 0, 3, 3, 4, 4, 7, 7}));
}

TEST(KeyframeClusters, ALongFlightHasFewerAnchors) {
  EXPECT_EQ(mains(fewAnchors(keyframes(7), 7)), (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(mains(fewAnchors(keyframes(7), 4)), (std::vector<std::size_t>{0, 0, 2, 2, 4, 4, 6}));
  EXPECT_EQ(mains(fewAnchors(keyframes(7), 4, 0.3)), (std::vector<std::size_t>{0, 0, 3, 3, 3, 6, 6}));
  const std::vector<std::size_t> half_a_minute = mains(fewAnchors(keyframes(300), 10));
  EXPECT_LE(std::set<std::size_t>(half_a_minute.begin(), half_a_minute.end()).size(), 10u);
}

TEST(KeyframeClusters, NoKeyframesNoAnchors) { EXPECT_TRUE(anchorsOf({}, 0.3).empty()); }

}  // namespace
}  // namespace lintel
