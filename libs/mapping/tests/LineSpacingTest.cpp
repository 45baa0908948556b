// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/LineSpacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace lintel {
namespace {

/// Lines seen from one keyframe at the origin whose camera is at the body's place.
class LineSpacing : public ::testing::Test {
 protected:
  LineSpacing() {
    map_.rig.T_b_c = Pose();
    map_.keyframes.resize(1);
  }

  /// A line along x from `from` to `to` at (y, z), seen `views` times.
  void add(double from, double to, double y, int views = 10, double z = 4) {
    MapLine line;
    line.id = map_.lines.size();
    line.segment_w = {{from, y, z}, {to, y, z}};
    line.observations.resize(static_cast<std::size_t>(views));
    map_.lines.push_back(line);
  }

  std::vector<std::uint64_t> left(int expected_gone) {
    EXPECT_EQ(spaceLines(params_, map_), expected_gone);
    std::vector<std::uint64_t> ids;
    for (const MapLine& line : map_.lines) ids.push_back(line.id);
    return ids;
  }

  using Ids = std::vector<std::uint64_t>;
  MapParams params_;
  LineMap map_;
};

TEST_F(LineSpacing, OfTwoSideBySideTheBetterSeenStays) {
  add(0, 1, 0, 8);
  add(0, 1, 0.04, 10);
  add(0, 1, 0.5);
  EXPECT_EQ(left(1), (Ids{1, 2}));
}

TEST_F(LineSpacing, LinesFartherApartStay) {
  add(0, 1, 0);
  add(0, 1, 0.06);
  EXPECT_EQ(left(0), (Ids{0, 1}));
}

TEST_F(LineSpacing, OneMuchBetterSeenClearsTwiceTheWidth) {
  add(0, 1, 0, 10);
  add(0, 1, 0.08, 31);
  EXPECT_EQ(left(1), Ids{1});
}

TEST_F(LineSpacing, TheNextEndToEndStays) {
  add(0, 1, 0, 20);
  add(1, 2, 0.01);
  add(1.4, 3, 0.02, 30);  // most of it beyond the one before, but over most of that
  EXPECT_EQ(left(1), (Ids{0, 2}));
}

TEST_F(LineSpacing, SeveralLinesTogetherCanCoverOne) {
  add(0, 1, 0, 40);
  add(1, 2, 0, 40);
  add(0.6, 1.4, 0.03, 5);
  EXPECT_EQ(left(1), (Ids{0, 1}));
}

TEST_F(LineSpacing, WhatWentClearsNothing) {
  add(0, 1, 0, 12);
  add(0, 1, 0.04, 11);
  add(0, 1, 0.08, 10);  // beside the second only
  EXPECT_EQ(left(1), (Ids{0, 2}));
}

TEST_F(LineSpacing, CrossingLinesStay) {
  add(-1, 1, 0, 40);
  MapLine across = map_.lines.front();
  across.id = 1;
  across.segment_w = {{0, -0.04, 4}, {0, 0.04, 4.01}};
  map_.lines.push_back(across);
  EXPECT_EQ(left(0), (Ids{0, 1}));
}

TEST_F(LineSpacing, NearbyThingsMayBeFiner) {
  add(-0.1, 0.1, 0, 12, 0.5);  // seen from half a metre: three per cent are 1.5 cm
  add(-0.1, 0.1, 0.02, 12, 0.5);
  EXPECT_EQ(left(0), (Ids{0, 1}));
}

TEST_F(LineSpacing, ZeroDrawsAll) {
  params_.spacing.min_m = 0;
  add(0, 1, 0);
  add(0, 1, 0.001);
  EXPECT_EQ(left(0), (Ids{0, 1}));
}

TEST_F(LineSpacing, RunawayLinesAndAnEmptyMapDoNoHarm) {
  EXPECT_EQ(left(0), Ids{});
  add(0, 1e12, 0);
  add(0, std::numeric_limits<double>::infinity(), 0);
  add(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(left(0), (Ids{0, 1, 2}));
}

TEST_F(LineSpacing, GroupsAreThoseOfTheLinesThatStay) {
  for (int i = 0; i < 6; ++i) add(0, 1, 0.5 * i), add(0, 1, 0.5 * i + 0.01, 5);
  EXPECT_EQ(left(6).size(), 6u);
  ASSERT_EQ(map_.groups.size(), 1u);
  EXPECT_TRUE(std::all_of(map_.lines.begin(), map_.lines.end(), [](const MapLine& line) { return line.group == 0; }));
}

}  // namespace
}  // namespace lintel
