// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "LineExtent.h"
#include "LineMerging.h"
#include "LineSplitting.h"
#include "MergedRecords.h"
#include "PointMerging.h"
#include "SpatialIndex.h"
#include "TestMaterial.h"

namespace lintel {
namespace {

using namespace test;

class MergingTest : public testing::Test {
 protected:
  int merge(std::vector<LineRecord>& lines) const {
    const KeyframeCameras cameras(material_);
    for (LineRecord& line : lines) EXPECT_TRUE(fitLine(cameras, {}, line));
    return mergeLines(cameras, {}, params_, allowance_, lines);
  }
  int merge(std::vector<PointRecord>& points) const {
    const KeyframeCameras cameras(material_);
    for (PointRecord& point : points) EXPECT_TRUE(fitPoint(cameras, {}, point));
    return mergePoints(cameras, {}, params_, points);
  }
  Segment3 piece(double from, double to) const {
    const Eigen::Vector3d d = upright_.end - upright_.start;
    return {upright_.start + from * d, upright_.start + to * d};
  }

  MapMaterial material_ = materialAlongX(8);
  MergeParams params_;
  MergeAllowance allowance_;
  const Segment3 upright_{{1.8, -0.7, 4}, {1.9, 0.6, 4.1}};
};

TEST_F(MergingTest, ALineSeenAgainUnderAnotherIdentityIsOneLine) {
  std::vector<LineRecord> lines{lineOf(material_, 9, upright_, 5, 7), lineOf(material_, 4, upright_, 0, 3)};
  EXPECT_EQ(merge(lines), 1);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].id, 4u) << "the lowest id stays";
  EXPECT_EQ(lines[0].views.size(), 7u) << "observations are kept";
  for (std::size_t i = 1; i < 7; ++i) EXPECT_LE(lines[0].views[i - 1].keyframe, lines[0].views[i].keyframe);
}

TEST_F(MergingTest, PiecesOfOneEdgeAddUp) {
  std::vector<LineRecord> lines{lineOf(material_, 1, piece(0, 0.4), 0, 6), lineOf(material_, 2, piece(0.35, 0.7), 0, 2),
                                lineOf(material_, 3, piece(0.72, 1), 4, 7)};
  EXPECT_EQ(merge(lines), 2);
  ASSERT_EQ(lines.size(), 1u);
  const auto stretch = seenStretch(KeyframeCameras(material_), lines[0], 0.2);
  ASSERT_TRUE(stretch);
  EXPECT_NEAR(stretch->second - stretch->first, upright_.length(), 1e-3) << "also the piece that few views saw";
}

TEST_F(MergingTest, CollinearLinesWithAGapStayApart) {
  std::vector<LineRecord> lines{lineOf(material_, 1, piece(0, 0.3)), lineOf(material_, 2, piece(0.6, 1))};
  EXPECT_EQ(merge(lines), 0);
  EXPECT_EQ(lines.size(), 2u);
}

TEST_F(MergingTest, LinesSeenSideBySideAreTwo) {
  // 5 cm apart: 5.7 px in every image that sees both
  const Eigen::Vector3d beside(0.05, 0, 0);
  std::vector<LineRecord> lines{lineOf(material_, 1, upright_),
                                lineOf(material_, 2, {upright_.start + beside, upright_.end + beside})};
  EXPECT_EQ(merge(lines), 0);
}

TEST_F(MergingTest, OneLineMustExplainTheViewsOfBoth) {
  // never in one image together, yet 5 cm are too many pixels for one line
  const Eigen::Vector3d beside(0.05, 0, 0);
  std::vector<LineRecord> lines{lineOf(material_, 1, upright_, 0, 3),
                                lineOf(material_, 2, {upright_.start + beside, upright_.end + beside}, 4, 7)};
  EXPECT_EQ(merge(lines), 0);
}

TEST_F(MergingTest, LinesThatCrossStayTwo) {
  const Segment3 crossing{{1.6, -0.5, 4}, {2.1, 0.5, 4.1}};
  std::vector<LineRecord> lines{lineOf(material_, 1, upright_, 0, 3), lineOf(material_, 2, crossing, 4, 7)};
  EXPECT_EQ(merge(lines), 0);
}

TEST_F(MergingTest, APointFoundAgainIsOnePoint) {
  std::vector<PointRecord> points{pointOf(material_, 7, {1.7, 0.2, 5}, 0, 3),
                                  pointOf(material_, 9, {1.7, 0.2, 5}, 5, 7)};
  EXPECT_EQ(merge(points), 1);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].id, 7u);
  EXPECT_EQ(points[0].views.size(), 7u);
}

/// Where the second pass sees a line that the trajectory has put beside the first one.
Segment3 besides(const Segment3& segment, double by_m) {
  const Eigen::Vector3d by(by_m, 0, 0);
  return {segment.start + by, segment.end + by};
}

TEST_F(MergingTest, APassThatDriftedIsJoinedWhereTheTrajectoryMayStillMove) {
  const auto passes = [&] {
    return std::vector<LineRecord>{lineOf(material_, 1, upright_, 0, 3),
                                   lineOf(material_, 2, besides(upright_, 0.04), 4, 7)};
  };
  std::vector<LineRecord> lines = passes();
  EXPECT_EQ(merge(lines), 0) << "four centimetres are 4.6 pixels";
  allowance_.drift_px = 4;
  lines = passes();
  EXPECT_EQ(merge(lines), 1);
}

TEST_F(MergingTest, ADriftedPassBesideTwoLinesIsNotMerged) {
  allowance_.drift_px = 4;
  std::vector<LineRecord> lines{lineOf(material_, 1, upright_, 0, 3),
                                lineOf(material_, 2, besides(upright_, 0.07), 0, 3),
                                lineOf(material_, 3, besides(upright_, 0.03), 4, 7)};
  EXPECT_EQ(merge(lines), 0) << "either could be meant";
}

TEST_F(MergingTest, ADriftedPassWithTheBrighterSideOnTheOtherSideIsAnotherEdge) {
  allowance_.drift_px = 4;
  const Segment3 other = besides(upright_, 0.04);
  std::vector<LineRecord> lines{lineOf(material_, 1, upright_, 0, 3),
                                lineOf(material_, 2, Segment3{other.end, other.start}, 4, 7)};
  EXPECT_EQ(merge(lines), 0);
}

/// The edge at `segment`, seen later with the brighter side on the other side.
LineRecord otherContrast(const MapMaterial& material, const Segment3& segment) {
  return lineOf(material, 2, Segment3{segment.end, segment.start}, 4, 7);
}

TEST_F(MergingTest, TheOtherEdgeOfABoardIsAnotherLineAlsoWhereOneLineWouldExplainBoth) {
  std::vector<LineRecord> lines{lineOf(material_, 1, upright_, 0, 3), otherContrast(material_, upright_)};
  EXPECT_EQ(merge(lines), 0);
}

TEST_F(MergingTest, PiecesOfAnEdgeWhoseContrastChangesAreJoinedWhereTheyAgree) {
  allowance_.contrast = true;
  std::vector<LineRecord> lines{lineOf(material_, 1, upright_, 0, 3), otherContrast(material_, upright_)};
  EXPECT_EQ(merge(lines), 1);
}

TEST_F(MergingTest, EdgesOfOppositeContrastHalfAPixelApartAreTwo) {
  allowance_.contrast = true;
  const Segment3 beside = besides(upright_, 0.005);
  const auto withExact = [](LineRecord line) {
    for (LineView& view : line.views) view.sigma_px = 0.05f;
    return line;
  };
  const LineRecord edge = withExact(lineOf(material_, 1, upright_, 0, 3));
  std::vector<LineRecord> lines{edge, withExact(otherContrast(material_, beside))};
  EXPECT_EQ(merge(lines), 0) << "ten standard deviations";
  lines = {edge, withExact(lineOf(material_, 2, beside, 4, 7))};
  EXPECT_EQ(merge(lines), 1) << "with the same contrast one line explains both";
}

TEST_F(MergingTest, ATrackThatTheLineDoesNotExplainIsTakenOutAgain) {
  std::vector<LineRecord> lines{lineOf(material_, 7, upright_, 0, 4)};
  for (FrameId k = 5; k < 8; ++k) lines[0].views.push_back(viewOf(material_, k, 9, besides(upright_, 0.5)));
  lines[0].known = true;
  for (LineView& v : lines[0].views) v.inlier = v.track == 7 || v.keyframe == 5;
  ASSERT_EQ(splitLines(lines), 1);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].id, 7u);
  EXPECT_EQ(lines[0].views.size(), 5u);
  EXPECT_EQ(lines[1].id, 8u);
  EXPECT_EQ(lines[1].views.size(), 3u);
  EXPECT_EQ(lines[1].views[0].track, 9u);
  EXPECT_EQ(splitLines(lines), 0) << "what is not known yet stays";
}

TEST(PairAnswers, HoldUntilOneOfTheTwoGrows) {
  MergedRecords records(4);
  PairAnswers same(records);
  EXPECT_FALSE(same.of(0, 2)) << "not asked yet";
  same.set(0, 2, true);
  EXPECT_TRUE(same.isYes(0, 2));
  EXPECT_FALSE(same.of(0, 3)) << "another one";
  records.join(2, 3);
  EXPECT_EQ(records.rootOf(3), 2u);
  EXPECT_FALSE(same.of(0, 2)) << "with what was joined to it this may be otherwise";
  same.set(0, 2, false);
  ASSERT_TRUE(same.of(0, 2));
  EXPECT_FALSE(same.isYes(0, 2));
  same.clear();
  EXPECT_FALSE(same.of(0, 2));
}

TEST_F(MergingTest, PointsInOneImageAreTwo) {
  std::vector<PointRecord> points{pointOf(material_, 7, {1.7, 0.2, 5}, 0, 3),
                                  pointOf(material_, 9, {1.705, 0.2, 5}, 3, 7)};
  EXPECT_EQ(merge(points), 0);
}

TEST_F(MergingTest, PointsAFewPixelsApartAreTwo) {
  std::vector<PointRecord> points{pointOf(material_, 7, {1.7, 0.2, 5}, 0, 3),
                                  pointOf(material_, 9, {1.75, 0.2, 5}, 4, 7)};
  EXPECT_EQ(merge(points), 0);
}

std::vector<std::pair<std::size_t, std::size_t>> pairsOf(const SpatialIndex& index) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  index.eachPair([&pairs](std::size_t a, std::size_t b) { pairs.emplace_back(a, b); });
  return pairs;
}

TEST(SpatialIndex, FindsNeighboursAcrossCellBordersOnceAndInOrder) {
  SpatialIndex index(1.0);
  index.add(3, {0.9, 0.5, 0.5});
  index.add(1, {1.1, 0.5, 0.5});
  index.add(1, {1.2, 0.5, 0.5});
  index.add(2, {-0.2, -0.2, -0.2});
  index.add(0, {50, 0, 0});
  const std::vector<std::pair<std::size_t, std::size_t>> expected{{1, 3}, {2, 3}};
  EXPECT_EQ(pairsOf(index), expected);
}

TEST(SpatialIndex, PlacesThatAreNoneAreLeftOut) {
  SpatialIndex index(0.1);
  index.add(0, {std::nan(""), 0, 0});
  index.add(1, {1e300, 0, 0});
  index.add(2, {1e300, 0, 0});
  EXPECT_TRUE(pairsOf(index).empty());
}

}  // namespace
}  // namespace lintel
