// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/LineTriangulation.h"

#include <gtest/gtest.h>

#include <limits>

#include "TestWindow.h"

namespace lintel {
namespace {

using namespace test;

/// How far a segment's ends are from the track's line [m].
double distanceOf(const LineTrack& track, const Segment3& segment_w) {
  const PluckerLine line = lineInWorld(track);
  const auto distance = [&](const Eigen::Vector3d& p_w) {
    return (p_w - line.nearestPoint()).cross(line.d.normalized()).norm();
  };
  return std::max(distance(segment_w.start), distance(segment_w.end));
}

/// One line seen from all the given poses.
SlidingWindow seenFrom(const std::vector<Pose>& poses, const Segment3& segment_w) {
  SlidingWindow window = windowAt(poses);
  for (FrameId k = 0; k < poses.size(); ++k) seeLine(window, 1, k, segment_w);
  return window;
}

const Segment3 kUpright{{0.4, -0.8, 4}, {0.5, 0.7, 4.2}};

TEST(LineTriangulation, IsExactWithoutNoise) {
  SlidingWindow window =
      seenFrom({at(0, 0, 0), at(0.2, 0.1, 0), at(0.5, -0.1, 0.1), at(0.8, 0, 0), at(1, 0, 0)}, kUpright);
  LineTrack& track = window.lines[1];
  ASSERT_TRUE(triangulateLine(window, kParams, track));
  EXPECT_TRUE(track.triangulated);
  EXPECT_FALSE(track.degenerate());
  EXPECT_LT(distanceOf(track, kUpright), 1e-6);
  EXPECT_LT(lineError(window, track), 1e-5);
}

TEST(LineTriangulation, TwoViewsAreEnoughForALine) {
  SlidingWindow window = seenFrom({at(0, 0, 0), at(0.8, 0, 0)}, kUpright);
  ASSERT_TRUE(triangulateLine(window, kParams, window.lines[1]));
  EXPECT_LT(distanceOf(window.lines[1], kUpright), 1e-6);
}

TEST(LineTriangulation, HandlesAFlight) {
  TrackSimulationParams tracks;
  tracks.duration_s = 4;
  const TrackedFlight flight = fly(perfectImu(), tracks);
  SlidingWindow window = trueWindow(flight, 0, 20);
  triangulateLines(window, kParams);
  int triangulated = 0, degenerate = 0;
  for (const auto& [id, track] : window.lines) {
    if (!track.triangulated) continue;
    (track.degenerate() ? degenerate : triangulated)++;
    EXPECT_GE(static_cast<int>(track.sightings.size()), kParams.landmarks.line_min_observations);
    if (track.degenerate()) continue;
    EXPECT_LT(distanceOf(track, flight.sim.lines_w[flight.sim.line_of_track[id]]), 0.01) << "line " << id;
  }
  EXPECT_GT(triangulated, 30);
  EXPECT_GT(degenerate, 0) << "a window of two seconds leaves some lines open";
}

TEST(LineTriangulation, ALineThroughTheEpipoleIsDegenerate) {
  // moving along x; the line lies in a plane with the motion: all observation planes are the same
  SlidingWindow window = seenFrom({at(0, 0, 0), at(0.2, 0, 0), at(0.4, 0, 0), at(0.6, 0, 0), at(0.8, 0, 0)},
                                  {{-1, 0.5, 4}, {1.5, 0.6, 4.8}});
  EXPECT_FALSE(triangulateLine(window, kParams, window.lines[1]) && !window.lines[1].degenerate());
}

TEST(LineTriangulation, NearlyThroughTheEpipoleThereIsASolutionThatIsKnownToBeWorthless) {
  SlidingWindow window = seenFrom({at(0, 0, 0), at(0.2, 0.02, 0), at(0.4, -0.02, 0), at(0.6, 0.01, 0), at(0.8, 0, 0)},
                                  {{-1, 0.5, 4}, {1.5, 0.6, 4.8}});
  ASSERT_TRUE(triangulateLine(window, kParams, window.lines[1]));
  EXPECT_TRUE(window.lines[1].degenerate());
  EXPECT_GT(window.lines[1].sigma_direction_rad, kParams.degeneracy.max_sigma_direction_rad);
}

TEST(LineTriangulation, RailsSeenWhileMovingAlongThemAreDegenerate) {
  // both rails converge to the epipole, straight ahead: moving along them shows nothing of their distance
  for (const double side : {-0.7, 0.7}) {
    SlidingWindow window = seenFrom({at(0, 0, 0), at(0, 0, 0.3), at(0, 0, 0.6), at(0, 0, 0.9), at(0, 0, 1.2)},
                                    {{side, 1, 3}, {side, 1, 9}});
    EXPECT_FALSE(triangulateLine(window, kParams, window.lines[1]) && !window.lines[1].degenerate()) << side;
  }
}

TEST(LineTriangulation, RailsAreKnownOnceTheCameraMovesAcross) {
  SlidingWindow window = seenFrom({at(0, 0, 0), at(0.2, 0, 0.3), at(0.4, 0, 0.6), at(0.6, 0, 0.9), at(0.8, 0, 1.2)},
                                  {{0.7, 1, 3}, {0.7, 1, 9}});
  ASSERT_TRUE(triangulateLine(window, kParams, window.lines[1]));
  EXPECT_FALSE(window.lines[1].degenerate());
}

TEST(LineTriangulation, ADegenerateLineIsTriedAgainWithNewSightings) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0.002, 0, 0.3), at(0, 0, 0.6), at(0, 0.001, 0.9), at(0.9, 0, 1.2)});
  const Segment3 rail{{0.7, 1, 3}, {0.7, 1, 9}};
  for (FrameId k = 0; k < 4; ++k) seeLine(window, 1, k, rail);
  triangulateLines(window, kParams);
  ASSERT_FALSE(window.lines[1].triangulated && !window.lines[1].degenerate());
  seeLine(window, 1, 4, rail);
  triangulateLines(window, kParams);
  EXPECT_TRUE(window.lines[1].triangulated);
  EXPECT_FALSE(window.lines[1].degenerate());
  EXPECT_LT(distanceOf(window.lines[1], rail), 1e-4);
}

TEST(LineTriangulation, ContradictionsGiveNoUsableLine) {
  SlidingWindow window = seenFrom({at(0, 0, 0), at(0.3, 0, 0), at(0.6, 0, 0), at(0.9, 0, 0), at(1.2, 0, 0)}, kUpright);
  LineTrack& track = window.lines[1];
  for (std::size_t i = 0; i < track.sightings.size(); ++i)
    for (RayObservation* end : {&track.sightings[i].start, &track.sightings[i].end})
      end->ray.x() += (i % 2 == 0 ? 20.0 : -20.0) / 500;
  EXPECT_FALSE(triangulateLine(window, kParams, track) && !track.degenerate());
}

TEST(LineTriangulation, FewSightingsAreLeftForLater) {
  SlidingWindow window = seenFrom({at(0, 0, 0), at(0.3, 0, 0), at(0.6, 0, 0)}, kUpright);
  triangulateLines(window, kParams);
  EXPECT_FALSE(window.lines[1].triangulated);
}

TEST(LineError, IsTheMeanDistanceOfTheEndsInPixels) {
  SlidingWindow window =
      seenFrom({at(0, 0, 0), at(0.4, 0, 0), at(0.8, 0, 0), at(1.2, 0, 0)}, {{0.4, -0.8, 4}, {0.4, 0.7, 4}});
  LineTrack& track = window.lines[1];
  ASSERT_TRUE(triangulateLine(window, kParams, track));
  EXPECT_NEAR(lineError(window, track), 0, 1e-5);
  track.sightings[1].start.ray.x() += 6.0 / 500;  // an upright line: straight across
  EXPECT_NEAR(lineError(window, track), 6.0 / 2 / 4, 1e-4);
  track.sightings[1].start.ray.y() += 50.0 / 500;  // along it: nothing
  EXPECT_NEAR(lineError(window, track), 6.0 / 2 / 4, 1e-4);
  window.frames[2].pose = toBlock(at(0, 0, 9));  // past the line
  EXPECT_EQ(lineError(window, track), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace lintel
