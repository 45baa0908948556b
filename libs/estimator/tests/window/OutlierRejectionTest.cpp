// SPDX-License-Identifier: BSD-3-Clause
#include "window/OutlierRejection.h"

#include <gtest/gtest.h>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"

namespace lintel {
namespace {

using namespace test;

/// A good point (1) and line (1), and another of each (2) to spoil; all triangulated.
class OutlierRejectionTest : public testing::Test {
 protected:
  OutlierRejectionTest() : window_(windowAt({at(0, 0, 0), at(0.3, 0, 0), at(0.6, 0, 0), at(0.9, 0, 0)})) {
    for (FrameId k = 0; k < 4; ++k) {
      seePoint(window_, 1, k, {0.2, 0.1, 4});
      seePoint(window_, 2, k, {0.5, -0.3, 5});
      seeLine(window_, 1, k, {{0.2, -0.8, 4}, {0.3, 0.8, 4}});
      seeLine(window_, 2, k, {{0.7, -0.8, 5}, {0.6, 0.8, 5}});
    }
    triangulatePoints(window_, params_.landmarks, 1);
    triangulateLines(window_, params_);
    for (const TrackId id : {1, 2}) {
      EXPECT_TRUE(window_.points.at(id).triangulated);
      EXPECT_TRUE(window_.lines.at(id).triangulated);
    }
  }

  EstimatorParams params_;
  SlidingWindow window_;
};

TEST_F(OutlierRejectionTest, WhatAgreesStays) {
  EXPECT_EQ(rejectOutliers(window_, params_.landmarks), 0);
  EXPECT_EQ(window_.points.at(2).sightings.size(), 4u);
}

TEST_F(OutlierRejectionTest, APointThatContradictsStartsAnewFromItsNewestSighting) {
  PointTrack& bad = window_.points.at(2);
  bad.former.push_back(bad.sightings[0]);
  bad.sightings[1].px.y() += 5 * params_.landmarks.point_max_error_px;
  EXPECT_EQ(rejectOutliers(window_, params_.landmarks), 1);
  EXPECT_FALSE(bad.triangulated);
  ASSERT_EQ(bad.sightings.size(), 1u);
  EXPECT_EQ(bad.sightings[0].frame, 3u);
  EXPECT_TRUE(bad.former.empty());
  EXPECT_TRUE(window_.points.at(1).triangulated);
  EXPECT_TRUE(window_.lines.at(2).triangulated);
}

TEST_F(OutlierRejectionTest, ALineThatContradictsStartsAnewFromItsNewestSighting) {
  LineTrack& bad = window_.lines.at(2);
  for (RayObservation* end : {&bad.sightings[1].start, &bad.sightings[1].end})
    end->ray.x() += 5 * params_.landmarks.line_max_error_px / 500;
  EXPECT_EQ(rejectOutliers(window_, params_.landmarks), 1);
  EXPECT_FALSE(bad.triangulated);
  ASSERT_EQ(bad.sightings.size(), 1u);
  EXPECT_EQ(bad.sightings[0].frame, 3u);
  EXPECT_TRUE(window_.lines.at(1).triangulated);
}

TEST_F(OutlierRejectionTest, APointBehindACameraIsAnOutlier) {
  window_.frames[1].pose = toBlock(at(0.3, 0, 30));
  EXPECT_EQ(rejectOutliers(window_, params_.landmarks), 4);
}

}  // namespace
}  // namespace lintel
