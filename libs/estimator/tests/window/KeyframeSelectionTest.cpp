// SPDX-License-Identifier: BSD-3-Clause
#include "window/KeyframeSelection.h"

#include <gtest/gtest.h>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

/// Three frames; `count` points at 5 m are seen in all of them, the second frame is `shift_m` to the side of the first.
SlidingWindow threeFrames(double shift_m, int count) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(shift_m, 0, 0), at(shift_m, 0, 0)});
  for (int i = 0; i < count; ++i)
    for (FrameId k = 0; k < 3; ++k) seePoint(window, static_cast<TrackId>(i), k, {0.05 * i - 1, 0.1 * (i % 7), 5});
  return window;
}

TEST(KeyframeSelection, ParallaxMakesAKeyframe) {
  EstimatorParams params;
  params.keyframe_parallax_px = 10;  // 0.1 m at 5 m and f = 500 px
  EXPECT_FALSE(secondNewestIsKeyframe(threeFrames(0.09, 40), params));
  EXPECT_TRUE(secondNewestIsKeyframe(threeFrames(0.11, 40), params));
}

TEST(KeyframeSelection, FewSharedPointsMakeAKeyframe) {
  EstimatorParams params;
  params.keyframe_min_tracked = 20;
  EXPECT_TRUE(secondNewestIsKeyframe(threeFrames(0, 19), params));
  EXPECT_FALSE(secondNewestIsKeyframe(threeFrames(0, 20), params));
}

TEST(KeyframeSelection, MuchTimeMakesAKeyframe) {
  EstimatorParams params;
  params.max_keyframe_interval_s = 3;
  SlidingWindow window = threeFrames(0, 40);
  window.frames[1].t_ns = window.frames[0].t_ns + 2'900'000'000;
  EXPECT_FALSE(secondNewestIsKeyframe(window, params));
  window.frames[1].t_ns = window.frames[0].t_ns + 3'100'000'000;
  EXPECT_TRUE(secondNewestIsKeyframe(window, params));
}

TEST(KeyframeSelection, ARestBeginsWithAKeyframe) {
  SlidingWindow window = threeFrames(0, 40);
  window.frames[2].still = true;
  EXPECT_TRUE(secondNewestIsKeyframe(window, {}));
  window.frames[1].still = true;
  EXPECT_FALSE(secondNewestIsKeyframe(window, {})) << "it has not moved since";
}

TEST(KeyframeSelection, ARestEndsWithAKeyframe) {
  SlidingWindow window = threeFrames(0, 40);
  window.frames[1].at_rest = true;
  EXPECT_FALSE(secondNewestIsKeyframe(window, {})) << "a short one";
  window.frames[1].t_ns = window.frames[0].t_ns + 1'000'000'000;
  EXPECT_TRUE(secondNewestIsKeyframe(window, {}));
  window.frames[2].at_rest = true;
  EXPECT_FALSE(secondNewestIsKeyframe(window, {})) << "it rests on";
}

TEST(KeyframeSelection, TheFirstFramesAreKeyframes) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0, 0, 0)});
  EXPECT_TRUE(secondNewestIsKeyframe(window, {}));
}

TEST(FeaturesInNewest, CountOnlyWhatTheNewestFrameSaw) {
  SlidingWindow window = threeFrames(0, 30);
  for (TrackId id = 100; id < 105; ++id) seePoint(window, id, 1, {0, 0, 5});
  for (FrameId k = 0; k < 3; ++k) seeLine(window, 1, k, {{0, 0, 5}, {1, 0, 5}});
  seeLine(window, 2, 0, {{0, 0, 5}, {1, 0, 5}});
  EXPECT_EQ(pointsInNewest(window), 30);
  EXPECT_EQ(linesInNewest(window), 1);
}

}  // namespace
}  // namespace lintel
