// SPDX-License-Identifier: BSD-3-Clause
#include "LineExtent.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

using Stretch = std::pair<double, double>;

TEST(CoveredStretch, IsWhatTwoObservationsShare) {
  EXPECT_EQ(coveredStretch({{0, 3}, {1, 5}}, 0.2), Stretch(1, 3));
  EXPECT_EQ(coveredStretch({{0, 3}, {0, 3}}, 0.2), Stretch(0, 3));
}

TEST(CoveredStretch, OneThatRanPastTheEndDoesNotLengthenTheLine) {
  EXPECT_EQ(coveredStretch({{0, 2}, {0, 2}, {0, 2}, {0, 90}, {-7, 2}}, 0.2), Stretch(0, 2));
}

TEST(CoveredStretch, TheShareGrowsWithTheObservations) {
  // ten observations at a share of 0.3: three are needed
  std::vector<SeenPiece> seen(7, {0, 1});
  seen.insert(seen.end(), {{0, 2}, {0, 2}, {0, 3}});
  EXPECT_EQ(coveredStretch(seen, 0.3), Stretch(0, 2));
  EXPECT_EQ(coveredStretch(seen, 0.05), Stretch(0, 2)) << "at least two are needed whatever the share";
  EXPECT_EQ(coveredStretch(seen, 0.31), Stretch(0, 1));
}

TEST(CoveredStretch, AGapBetweenWellSeenPiecesIsBridged) {
  EXPECT_EQ(coveredStretch({{0, 1}, {0, 1}, {4, 5}, {4, 6}}, 0.2), Stretch(0, 5));
}

TEST(CoveredStretch, NothingWhereNothingIsSharedOrLong) {
  EXPECT_FALSE(coveredStretch({}, 0.2));
  EXPECT_FALSE(coveredStretch({SeenPiece{0, 5}}, 0.2)) << "one observation is no evidence";
  EXPECT_FALSE(coveredStretch({{0, 1}, {2, 3}}, 0.2));
  EXPECT_FALSE(coveredStretch({{1, 1}, {1, 1}}, 0.2)) << "no length";
}

TEST(CoveredStretch, AViewThatEndsAtTheImagesBorderSaysNothingOfWhatIsBeyond) {
  // ten views saw the first metre and two the second
  const auto seen = [](bool cut_off) {
    std::vector<SeenPiece> pieces(10, {0, 1, false, cut_off});
    pieces.insert(pieces.end(), {{0.5, 2}, {0.5, 2}});
    return pieces;
  };
  EXPECT_EQ(coveredStretch(seen(false), 0.3), Stretch(0, 1)) << "ten of twelve say that it ends there";
  EXPECT_EQ(coveredStretch(seen(true), 0.3), Stretch(0, 2));
}

TEST(CoveredStretch, OpenAtTheOtherEnd) {
  std::vector<SeenPiece> pieces(10, {1, 2, true, false});
  pieces.insert(pieces.end(), {{0, 1.5}, {0, 1.5}});
  EXPECT_EQ(coveredStretch(pieces, 0.3), Stretch(0, 2));
  for (SeenPiece& piece : pieces) piece.from_open = false;
  EXPECT_EQ(coveredStretch(pieces, 0.3), Stretch(1, 2));
}

TEST(CoveredStretch, PiecesThatOnlyTouchShareNoLength) { EXPECT_FALSE(coveredStretch({{0, 1}, {1, 2}}, 0.2)); }

}  // namespace
}  // namespace lintel
