// SPDX-License-Identifier: BSD-3-Clause
#include "window/LandmarkCounts.h"

#include <gtest/gtest.h>

#include "TestWindow.h"
#include "landmarks/PointTriangulation.h"

namespace lintel {
namespace {

using namespace test;

TEST(LandmarkCounts, PointsAreAsFarFromTheNewestPoseAsTheMedianOfThoseUsed) {
  SlidingWindow window = windowAt({at(0, 0, 0), at(1, 0, 0)});
  TrackId id = 0;
  for (const double distance_m : {3.0, 4.0, 40.0, 50.0}) {
    seePoint(window, ++id, 0, {1, 0, distance_m});
    seePoint(window, id, 1, {1, 0, distance_m});
    triangulatePoint(window, kParams.landmarks, 0.1, window.points[id]);
  }
  window.points[4].triangulated = false;
  WindowUpdate update;
  countLandmarks(window, kParams.degeneracy, update);
  EXPECT_EQ(update.points_used, 3);
  EXPECT_NEAR(update.points_distance_m, 4, 1e-6);
  countLandmarks(window, kParams.degeneracy, update);
  EXPECT_EQ(update.points_used, 3) << "a start that is solved twice does not have twice as many";
  WindowUpdate none;
  countLandmarks(windowAt({at(0, 0, 0)}), kParams.degeneracy, none);
  EXPECT_EQ(none.points_distance_m, 0);
}

}  // namespace
}  // namespace lintel
