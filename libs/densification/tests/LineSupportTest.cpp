// SPDX-License-Identifier: BSD-3-Clause
#include "LineSupport.h"

#include <gtest/gtest.h>

#include "TestFlight.h"

namespace lintel {
namespace {

const EdgeLook kAny(EdgeSegment{});

/// One camera at the origin that looks along z, 100 px a radian at the image's middle, no distortion.
class LineSupportTest : public testing::Test {
 protected:
  LineSupportTest() {
    material_.rig.camera = {400, 400, 100, 100, 200, 200, 0, 0, 0, 0};
    material_.keyframes.emplace_back();
  }

  SegmentView viewOf(std::vector<EdgeSegment> edges) const { return {cameras(), 0, std::move(edges)}; }
  const KeyframeCameras& cameras() const {
    if (!made_) made_.emplace(material_);
    return *made_;
  }

  MapMaterial material_;
  mutable std::optional<KeyframeCameras> made_;
  const Segment3 segment_{{-0.5, 0, 1}, {0.5, 0, 1}};  // 100 px in the middle, its right side below
};

TEST_F(LineSupportTest, CoverIsTheShareOfItsAngleOnEdges) {
  const SegmentView view = viewOf({{{150, 200}, {200, 200}, 0.3f}});
  const SeenSegment seen = seenSegment(view, segment_);
  EXPECT_NEAR(seen.length_rad, 2 * std::atan(0.5), 1e-9);
  const LineSupport support = supportOf(view, seen, 2, false, nullptr);
  EXPECT_TRUE(support.visible);
  EXPECT_NEAR(support.cover, 0.5, 1e-6);
  EXPECT_EQ(support.by, std::vector<std::size_t>{0});
}

TEST_F(LineSupportTest, EdgesThatOverlapCountOnce) {
  const SegmentView view = viewOf({{{150, 200}, {210, 200}, 0.3f}, {{190, 200.5}, {250, 200.5}, 0.3f}});
  EXPECT_NEAR(supportOf(view, seenSegment(view, segment_), 2, false, nullptr).cover, 1, 1e-6);
}

TEST_F(LineSupportTest, OnlyEdgesThatMayBeItsOwnCount) {
  const EdgeSegment aside{{150, 203}, {250, 203}, 0.3f}, turned{{150, 198.5}, {165, 201.5}, 0.3f},
      other_side{{250, 200}, {150, 200}, 0.3f}, beyond{{300, 200}, {390, 200}, 0.3f};
  for (const EdgeSegment& edge : {aside, turned, other_side, beyond}) {
    const SegmentView view = viewOf({edge});
    EXPECT_EQ(supportOf(view, seenSegment(view, segment_), 2, false, nullptr).cover, 0) << edge.start_px.transpose();
  }
}

TEST_F(LineSupportTest, TakenEdgesCountWhereAskedFor) {
  SegmentView view = viewOf({{{150, 200}, {250, 200}, 0.3f}});
  view.taken[0] = 1;
  EXPECT_EQ(supportOf(view, seenSegment(view, segment_), 2, false, nullptr).cover, 0);
  EXPECT_NEAR(supportOf(view, seenSegment(view, segment_), 2, true, nullptr).cover, 1, 1e-6);
}

TEST_F(LineSupportTest, EdgesOfOtherGreyLevelsDoNotCount) {
  const SegmentView view = viewOf({{{150, 200}, {250, 200}, 0.3f, 80, 120}});
  const auto cover = [&](float dark, float bright) {
    const EdgeLook look(EdgeSegment{{}, {}, 0.3f, dark, bright});
    return supportOf(view, seenSegment(view, segment_), 2, false, &look).cover;
  };
  EXPECT_NEAR(cover(80, 120), 1, 1e-6);
  EXPECT_NEAR(cover(90, 110), 1, 1e-6) << "blur takes contrast";
  EXPECT_NEAR(cover(100, 150), 1, 1e-6) << "the exposure has changed";
  EXPECT_EQ(cover(120, 160), 0) << "the next step of a staircase";
  EXPECT_EQ(cover(30, 60), 0);
}

TEST_F(LineSupportTest, ASegmentOutsideTheImageOrBehindIsNotSeen) {
  const SegmentView view = viewOf({});
  for (const Segment3& s : {Segment3{{5, 0, 1}, {6, 0, 1}}, Segment3{{-0.5, 0, -1}, {0.5, 0, -1}}}) {
    EXPECT_EQ(seenSegment(view, s).length_rad, 0);
    EXPECT_FALSE(supportOf(view, seenSegment(view, s), 2, false, nullptr).visible);
  }
}

TEST_F(LineSupportTest, OfALongSegmentThePartWithinTheImageIsSeen) {
  const SegmentView view = viewOf({});
  const SeenSegment seen = seenSegment(view, {{-4, 0, 1}, {4, 0, 1}});
  EXPECT_NEAR(seen.length_rad, 2 * std::atan(1.0), 1e-6) << "one of eight parts to each side";
}

TEST_F(LineSupportTest, ChanceIsWhatEdgesBesideWouldCover) {
  const SegmentView alone = viewOf({{{150, 200}, {250, 200}, 0.3f}});
  EXPECT_EQ(chanceOf(alone, seenSegment(alone, segment_), 2, kAny), 0) << "its own edge is no chance";
  std::vector<EdgeSegment> hatching;
  for (double y = 150; y <= 250; y += 3) hatching.push_back({{120, y}, {280, y}, 0.3f});
  const SegmentView hatched = viewOf(hatching);
  EXPECT_GT(chanceOf(hatched, seenSegment(hatched, segment_), 2, kAny), 0.9);
}

TEST(BinomialTail, ByHand) {
  EXPECT_DOUBLE_EQ(binomialTail(0, 5, 0.3), 1);
  EXPECT_NEAR(binomialTail(2, 3, 0.5), 0.5, 1e-12);
  EXPECT_NEAR(binomialTail(3, 3, 0.1), 1e-3, 1e-12);
  EXPECT_NEAR(binomialTail(1, 2, 0.1), 0.19, 1e-12);
  EXPECT_EQ(binomialTail(1, 2, 0), 0);
  EXPECT_EQ(binomialTail(2, 2, 1), 1);
  EXPECT_NEAR(binomialTail(1, 3000, 0.5), 1, 1e-9);            // the first terms are below the smallest double
  EXPECT_NEAR(binomialTail(1000, 2000, 0.5), 0.508920, 1e-6);  // half and half the middle term, 1 / sqrt(1000 pi)
}

}  // namespace
}  // namespace lintel
