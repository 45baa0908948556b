// SPDX-License-Identifier: BSD-3-Clause
#include "LineGroups.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

std::vector<MapLine> linesAlong(const std::vector<std::pair<Eigen::Vector3d, int>>& directions) {
  std::vector<MapLine> lines;
  for (const auto& [direction, count] : directions)
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d start(0.3 * i, 1, 2);
      // every second one the other way round, all of them a little turned
      const Eigen::Vector3d d =
          expRotation(Eigen::Vector3d(0.004, -0.006, 0.005) * (i % 3 - 1)) * direction.normalized();
      MapLine line;
      line.id = lines.size();
      line.segment_w = {start, start + (i % 2 ? -1.0 : 1.0) * d};
      lines.push_back(line);
    }
  return lines;
}

TEST(LineGroups, FindsAndNamesTheDirectionsOfAHall) {
  auto lines = linesAlong({{{0.6, 0.8, 0}, 12}, {{0, 0, 1}, 20}, {{-0.8, 0.6, 0}, 9}, {{1, 0, 1}, 8}});
  const auto groups = findGroups({}, lines);
  ASSERT_EQ(groups.size(), 4u);
  EXPECT_EQ(groups[0].name, "vertical");
  EXPECT_EQ(groups[1].name, "horizontal 1");
  EXPECT_EQ(groups[2].name, "horizontal 2");
  EXPECT_EQ(groups[3].name, "slanted 1");
  EXPECT_LT(lineAngle(groups[1].direction_w, {0.6, 0.8, 0}), 0.003);
  EXPECT_GT(groups[1].spread_rad, 0.003);
  EXPECT_LT(groups[1].spread_rad, 0.01);
  for (const MapLine& line : lines) EXPECT_EQ(line.group, line.id < 12 ? 1 : line.id < 32 ? 0 : line.id < 41 ? 2 : 3);
}

TEST(LineGroups, FewLinesAreNoGroup) {
  auto lines = linesAlong({{{1, 0, 0}, 12}, {{0, 1, 0}, 3}});
  lines[13].group = 5;  // of an earlier search
  const auto groups = findGroups({}, lines);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(lines[13].group, -1);
}

TEST(LineGroups, AGroupIsCertainFromATenthOfTheLengthOn) {
  LineMap map;
  map.lines =
      linesAlong({{{1, 0, 0}, 14}, {{0, 0, 1}, 20}, {{0, 1, 0}, 12}, {{1, 0, 1}, 5}, {{1, 1, 1}, 2}, {{-1, 2, 1}, 2}});
  map.groups = findGroups({}, map.lines);
  ASSERT_EQ(map.groups.size(), 4u);
  EXPECT_EQ(certainGroups(map), (std::vector<bool>{true, true, true, false})) << "5 of 55 lines are no tenth";
  EXPECT_TRUE(certainGroups({}).empty());
}

TEST(LineGroups, NoLinesNoGroups) {
  std::vector<MapLine> none;
  EXPECT_TRUE(findGroups({}, none).empty());
}

}  // namespace
}  // namespace lintel
