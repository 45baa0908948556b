// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/ParallelGroups.h"

#include <gtest/gtest.h>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"

namespace lintel {
namespace {

using namespace test;

const std::vector<Pose> kAhead{at(0, 0, 0), at(0, 0, 0.1), at(0, 0, 0.2), at(0, 0, 0.3), at(0, 0, 0.4)};

/// A line seen by all frames.
void seeEverywhere(SlidingWindow& window, TrackId id, const Segment3& segment_w) {
  for (const WindowFrame& frame : window.frames) seeLine(window, id, frame.id, segment_w);
}

/// `count` rails along the camera's axis, from outside the image to far away.
SlidingWindow windowWithRails(int count) {
  SlidingWindow window = windowAt(kAhead);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d side(1.5 * std::cos(1.1 * i), 1.2 * std::sin(1.1 * i), 0);
    seeEverywhere(window, static_cast<TrackId>(i) + 1,
                  {side + Eigen::Vector3d(0, 0, 0.8), side + Eigen::Vector3d(0, 0, 30)});
  }
  triangulateLines(window, kParams);
  return window;
}

Eigen::Vector3d directionInWorld(const LineTrack& track) { return lineInWorld(track).d.normalized(); }

TEST(ParallelGroups, RailsAlongTheMotionShareItsDirection) {
  SlidingWindow window = windowWithRails(6);
  for (const auto& [id, track] : window.lines) ASSERT_TRUE(track.degenerate()) << id;
  groupParallelLines(window, kParams);
  ASSERT_EQ(window.directions.size(), 1u);
  for (const auto& [id, track] : window.lines) {
    EXPECT_NE(track.group, 0u);
    EXPECT_LT(directionInWorld(track).cross(Eigen::Vector3d::UnitZ()).norm(), 1e-3);
  }
}

TEST(ParallelGroups, TwoLinesAreNoWitnesses) {
  SlidingWindow window = windowWithRails(2);
  groupParallelLines(window, kParams);
  EXPECT_TRUE(window.directions.empty());
  for (const auto& [id, track] : window.lines) EXPECT_EQ(track.group, 0u);
}

TEST(ParallelGroups, ALineWhosePlaneDoesNotHoldTheDirectionStaysOut) {
  SlidingWindow window = windowWithRails(6);
  seeEverywhere(window, 50, {{-1, 1, 4}, {1, 0.2, 5}});
  window.lines[50].verdict = LineVerdict::kDirectionUnknown;
  groupParallelLines(window, kParams);
  EXPECT_EQ(window.lines[50].group, 0u);
  EXPECT_GT(directionMisfit(window, kParams, window.lines[50], Eigen::Vector3d::UnitZ()), 10);
  EXPECT_LT(directionMisfit(window, kParams, window.lines[1], Eigen::Vector3d::UnitZ()), 0.1);
}

TEST(ParallelGroups, ALineWithADirectionOfItsOwnIsReleased) {
  SlidingWindow window = windowWithRails(6);
  groupParallelLines(window, kParams);
  ASSERT_NE(window.lines[1].group, 0u);
  WindowFrame aside;  // from the side, line 1 has parallax
  aside.id = window.frames.back().id + 1;
  aside.pose = toBlock(at(-0.8, 0.7, 0.4));
  window.addFrame(aside, {});
  seeLine(window, 1, aside.id, {{1.5, 0, 0.8}, {1.5, 0, 30}});  // where windowWithRails puts it
  groupParallelLines(window, kParams);
  EXPECT_EQ(window.lines[1].group, 0u);
  EXPECT_EQ(window.lines[1].verdict, LineVerdict::kGood);
  EXPECT_NE(window.lines[2].group, 0u);
}

TEST(ParallelGroups, EndsThatLookFixedAreWaitedForAndMayContradict) {
  // a pole that lies in one plane with the motion, its ends well inside the image
  SlidingWindow window = windowWithRails(6);
  groupParallelLines(window, kParams);
  const Segment3 pole{{0.3, 0.2, 1.2}, {0.9, 0.6, 2.2}};
  for (const WindowFrame& frame : window.frames) seeLine(window, 60, frame.id, pole);
  triangulateLines(window, kParams);
  ASSERT_TRUE(window.lines[60].degenerate());
  ASSERT_LT(directionMisfit(window, kParams, window.lines[60], Eigen::Vector3d::UnitZ()), 1)
      << "its plane holds the direction";
  groupParallelLines(window, kParams);
  EXPECT_EQ(window.lines[60].group, 0u);
}

TEST(ParallelGroups, ADirectionThatWasOnlyTriedDoesNotKeepALineFromItsOwn) {
  // An edge across the view, in one plane with the motion along it and with the vertical, which is tried first: its
  // ends contradict the vertical and agree with the rails beside it.
  SlidingWindow window = windowAt({at(0, 0, 0), at(0.1, 0, 0), at(0.2, 0, 0), at(0.3, 0, 0), at(0.4, 0, 0)});
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d side(0, 0.8 * std::cos(1.3 * i), 3 + 0.5 * i);
    seeEverywhere(window, static_cast<TrackId>(i) + 1,
                  {side - Eigen::Vector3d(20, 0, 0), side + Eigen::Vector3d(20, 0, 0)});
  }
  seeEverywhere(window, 60, {{-0.3, 0, 2}, {0.5, 0, 2}});
  triangulateLines(window, kParams);
  ASSERT_TRUE(window.lines[60].degenerate());
  ASSERT_LT(directionMisfit(window, kParams, window.lines[60], Eigen::Vector3d::UnitZ()), 1);
  groupParallelLines(window, kParams);
  ASSERT_EQ(window.directions.size(), 1u);
  EXPECT_GT(std::abs(window.directions.begin()->second.d_w.x()), 0.999);
  EXPECT_NE(window.lines[60].group, 0u);
}

TEST(ParallelGroups, ADirectionThatNobodyNeedsIsForgotten) {
  SlidingWindow window = windowWithRails(6);
  groupParallelLines(window, kParams);
  ASSERT_EQ(window.directions.size(), 1u);
  window.lines.clear();
  window.frames.back().id += 1000;
  groupParallelLines(window, kParams);
  EXPECT_TRUE(window.directions.empty());
}

}  // namespace
}  // namespace lintel
