// SPDX-License-Identifier: BSD-3-Clause
#include "LineExtent.h"

#include <gtest/gtest.h>

#include "TestMaterial.h"

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

/// A line that most keyframes see up to the border of their images, and some farther.
class SeenStretchTest : public testing::Test {
 protected:
  /// Keyframe k sees what is from `from` to `to` of it [m].
  LineView seen(FrameId k, double from, double to, bool turned = false) const {
    const Segment3 piece{whole_.start + from * whole_.direction(), whole_.start + to * whole_.direction()};
    return test::viewOf(material_, k, 1, turned ? Segment3{piece.end, piece.start} : piece);
  }
  Stretch stretchOf(const std::vector<LineView>& views) const {
    LineRecord line;
    line.views = views;
    line.known = true;
    line.estimate.middle_w = whole_.start;
    line.estimate.direction_w = whole_.direction();
    return seenStretch(KeyframeCameras(material_), line, 0.5).value_or(Stretch(0, 0));
  }
  /// Where along the line keyframe k's image ends, `margin_px` inside its border.
  double borderOf(FrameId k, double margin_px) const {
    double along = 0;
    while (material_.rig.camera.contains(
        test::pixelOf(material_, k, whole_.start + (along + 0.001) * whole_.direction()), margin_px))
      along += 0.001;
    return along;
  }

  MapMaterial material_ = test::materialAlongX();
  const Segment3 whole_{{0, -0.5, 4}, {9, -0.5, 4}};  // along the flight: later keyframes see farther
};

TEST_F(SeenStretchTest, TheDirectionOfAViewDoesNotMatter) {
  const Stretch stretch = stretchOf({seen(0, 0, 1), seen(1, 0, 1, true), seen(2, 0.2, 1, true)});
  EXPECT_NEAR(stretch.first, 0, 1e-6);
  EXPECT_NEAR(stretch.second, 1, 1e-6);
}

TEST_F(SeenStretchTest, ViewsCutOffByTheBorderSayNothingOfWhatIsBeyond) {
  for (const bool turned : {false, true}) {
    const double border = borderOf(0, 4), before = borderOf(0, 30);
    const auto views = [&](double end) {
      return std::vector<LineView>{seen(0, 0, end, turned), seen(0, 0, end, turned), seen(0, 0, end, turned),
                                   seen(3, 0, border, turned), seen(4, 0, border, turned)};
    };
    EXPECT_NEAR(stretchOf(views(before)).second, before, 1e-6) << "three of five say that it ends there";
    std::vector<LineView> cut = views(border);
    const double beyond = 1.2 * border;
    cut[3] = seen(3, 0, beyond, turned), cut[4] = seen(4, 0, beyond, turned);
    ASSERT_LT(beyond, borderOf(3, 30)) << "in the image of the later ones";
    EXPECT_NEAR(stretchOf(cut).second, beyond, 1e-6) << "the first three cannot tell";
  }
}

}  // namespace
}  // namespace lintel
