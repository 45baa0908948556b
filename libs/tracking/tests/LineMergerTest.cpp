// SPDX-License-Identifier: BSD-3-Clause
#include "LineMerger.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

const LineCamera kCamera(Camera{752, 480, 458, 458, 375, 240, {}});

ImageLine horizontal(double x0, double x1, double y) { return {{x0, y}, {x1, y}}; }

TEST(LineMerger, takesBothPiecesOfASplitLine) {
  const MergedLines merged =
      LineMerger(kCamera, {}).merge({horizontal(0, 100, 0)}, {horizontal(-20, 40, 1), horizontal(50, 120, -1)});
  ASSERT_EQ(merged.lines.size(), 1u);
  EXPECT_EQ(merged.detections[0], 2);
  EXPECT_TRUE(merged.fresh.empty());
  EXPECT_NEAR(merged.lines[0].start.x(), -20, 0.1);
  EXPECT_NEAR(merged.lines[0].end.x(), 120, 0.1);
}

TEST(LineMerger, keepsTheExtentOfACutLineAndAMissedLine) {
  const MergedLines merged =
      LineMerger(kCamera, {}).merge({horizontal(0, 100, 0), horizontal(0, 100, 50)}, {horizontal(20, 60, 0)});
  EXPECT_EQ(merged.detections[0], 1);
  EXPECT_NEAR(merged.lines[0].length(), 100, 1e-9);
  EXPECT_EQ(merged.detections[1], 0);
  EXPECT_NEAR(merged.lines[1].length(), 100, 1e-9);
}

TEST(LineMerger, givesADetectionToTheBetterPrediction) {
  const MergedLines merged =
      LineMerger(kCamera, {}).merge({horizontal(0, 100, 0), horizontal(0, 100, 4)}, {horizontal(0, 100, 2.9)});
  EXPECT_EQ(merged.detections[0], 0);
  EXPECT_EQ(merged.detections[1], 1);
}

TEST(LineMerger, keepsOppositeContrastDistantAndTiltedApart) {
  const std::vector<ImageLine> others = {
      horizontal(100, 0, 0), horizontal(0, 100, 5), {{0, 0}, {100, 12}}, horizontal(130, 200, 0)};
  const MergedLines merged = LineMerger(kCamera, {}).merge({horizontal(0, 100, 0)}, others);
  EXPECT_EQ(merged.detections[0], 0);
  EXPECT_EQ(merged.fresh.size(), others.size());
}

TEST(LineMerger, findsDuplicates) {
  const LineMerger merger(kCamera, {});
  EXPECT_TRUE(merger.duplicates(horizontal(0, 100, 0), horizontal(30, 90, 1)));
  EXPECT_TRUE(merger.duplicates(horizontal(30, 90, 1), horizontal(0, 100, 0)));
  EXPECT_FALSE(merger.duplicates(horizontal(0, 100, 0), horizontal(0, 100, 2)));
  EXPECT_FALSE(merger.duplicates(horizontal(0, 100, 0), horizontal(80, 180, 0)));
}

}  // namespace
}  // namespace lintel
