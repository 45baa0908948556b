// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/StartBuffer.h"

#include <gtest/gtest.h>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

/// Frames 0.1 s apart.
SlidingWindow buffer(std::size_t frames) {
  TrackSimulationParams tracks;
  tracks.duration_s = 4;
  return bufferOf(fly(ImuSimulatorParams{}, tracks), 0, frames);
}

TEST(StartBuffer, IsThinnedOutEvenly) {
  SlidingWindow window = buffer(7);
  const double span_s = 1e-9 * static_cast<double>(window.frames.back().t_ns - window.frames.front().t_ns);
  std::vector<std::size_t> left_out;
  while (window.frames.size() > 4) {
    left_out.push_back(frameToThinOut(window));
    leaveOut(left_out.back(), window);
  }
  // of the frames 0 to 6 first 1, then 3 (between 2 and 4), then 5 (between 4 and 6)
  EXPECT_EQ(left_out, (std::vector<std::size_t>{1, 2, 3}));
  double covered_s = 0;
  for (std::size_t k = 1; k < window.frames.size(); ++k) {
    EXPECT_NEAR(window.frames[k].imu->dt_s(), 0.2, 1e-6) << "the IMU's samples are joined";
    covered_s += window.frames[k].imu->dt_s();
  }
  EXPECT_NEAR(covered_s, span_s, 1e-6);
  for (const auto& [id, track] : window.points)
    for (const PointSighting& s : track.sightings) EXPECT_TRUE(window.contains(s.frame)) << "point " << id;
}

TEST(StartBuffer, LosesItsFirstFrameWhenItIsLongEnough) {
  SlidingWindow window = buffer(5);
  window.frames.back().t_ns += 20'000'000'000;
  EXPECT_EQ(frameToThinOut(window), 0u);
  const FrameId second = window.frames[1].id;
  leaveOut(0, window);
  EXPECT_EQ(window.frames.front().id, second);
  EXPECT_EQ(window.frames.front().imu, nullptr) << "what was before is not in the buffer";
}

TEST(StartBuffer, ItsNewestHalfIsABufferOfItsOwn) {
  const SlidingWindow whole = buffer(7);
  const SlidingWindow half = newestHalf(whole);
  ASSERT_EQ(half.frames.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(half.frames[k].id, whole.frames[k + 3].id);
  EXPECT_EQ(half.frames.front().imu, nullptr);
  EXPECT_EQ(half.frames[1].imu->dt_s(), whole.frames[4].imu->dt_s());
  for (const auto& [id, track] : half.points)
    for (const PointSighting& s : track.sightings) EXPECT_TRUE(half.contains(s.frame)) << "point " << id;
}

}  // namespace
}  // namespace lintel
