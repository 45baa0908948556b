// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/densification/Densifier.h"

#include <gtest/gtest.h>

#include "TestFlight.h"
#include "lintel/mapping/LineEvidence.h"
#include "lintel/mapping/LineFitting.h"

namespace lintel {
namespace {

using test::TestFlight;

class DensifierTest : public testing::Test {
 protected:
  DensifyReport densify(int threads = 1, const DensifyProgress& progress = {}) {
    return lintel::densify(flight_.params, flight_.map, flight_.edges, flight_.material, threads, progress);
  }

  LineEvidence evidence(const LineRecord& line) const {
    return evidenceOf(flight_.map, KeyframeCameras(flight_.material), line);
  }

  TestFlight flight_;
};

TEST_F(DensifierTest, FindsEveryLineThatTrackingMissed) {
  const std::vector<Segment3> segments = flight_.someSegments();
  for (const Segment3& segment : segments) flight_.show(segment);
  flight_.showNoise(60);
  const DensifyReport report = densify();
  EXPECT_EQ(report.images, 16U);
  EXPECT_EQ(report.segments, 16U * (12 + 60));
  ASSERT_EQ(report.lines, 12);
  ASSERT_EQ(flight_.material.lines.size(), 12U);
  for (const Segment3& segment : segments) {
    int found = 0;
    for (const LineRecord& line : flight_.material.lines) {
      EXPECT_TRUE(line.mapped);
      const LineEvidence seen = evidence(line);
      if (test::distanceTo(seen.segment_w, segment) > 0.02) continue;
      ++found;
      EXPECT_TRUE(seen.known);
      EXPECT_GE(line.views.size(), 14U);
      EXPECT_NEAR(seen.segment_w.length(), segment.length(), 0.06);
    }
    EXPECT_EQ(found, 1) << segment.start.transpose();
  }
}

TEST_F(DensifierTest, EdgesAtRandomPlacesMakeNoLines) {
  flight_.showNoise(150);
  EXPECT_EQ(densify().lines, 0);
  EXPECT_TRUE(flight_.material.lines.empty());
}

TEST_F(DensifierTest, AFenceGetsItsOwnPickets) {
  std::vector<Segment3> pickets;
  for (int i = 0; i < 14; ++i) {
    const double x = -1.3 + 0.2 * i;
    pickets.push_back({{x, -0.5, 5 + 0.1 * (i % 3)}, {x + 0.02, 0.5, 5 + 0.1 * (i % 3)}});
    flight_.show(pickets.back());
  }
  densify();
  EXPECT_GE(flight_.material.lines.size(), 12U);
  for (const LineRecord& line : flight_.material.lines) {
    double nearest = 1e9;
    for (const Segment3& picket : pickets)
      nearest = std::min(nearest, test::distanceTo(evidence(line).segment_w, picket));
    EXPECT_LT(nearest, 0.03) << "no line between the wrong pair of pickets";
  }
}

TEST_F(DensifierTest, NoLineReachesBehindWhatItsImagesShow) {
  const Segment3 segment{{-0.5, -0.3, 5}, {0.8, 0.4, 9}};
  flight_.show(segment);
  EXPECT_EQ(densify().lines, 0) << "its end is 4 m behind the wall";
  for (std::size_t i = 0; i < flight_.material.points.size(); i += 2) {  // as through a window
    PointRecord& point = flight_.material.points[i];
    point.p_w *= 2;
    for (std::size_t k = 0; k < point.views.size(); ++k)
      point.views[k].px = flight_.pixelOf(flight_.material.keyframes[k], point.p_w).cast<float>();
  }
  EXPECT_EQ(densify().lines, 1);
}

TEST_F(DensifierTest, ALineOfTheMapGetsViewsAndNoTwin) {
  const Segment3 segment{{-0.5, -0.3, 4.5}, {0.6, 0.2, 4.8}};
  flight_.show(segment);
  flight_.map.max_sigma_m = flight_.map.max_relative_sigma = 0.1;
  LineRecord tracked = flight_.trackedLine(5, segment, 8);
  ASSERT_TRUE(fitLine(KeyframeCameras(flight_.material), {}, tracked));
  ASSERT_TRUE(evidence(tracked).known);
  flight_.material.lines = {tracked};
  const DensifyReport report = densify();
  EXPECT_EQ(report.lines, 0);
  EXPECT_EQ(report.views, 8U);
  ASSERT_EQ(flight_.material.lines.size(), 1U);
  const LineRecord& line = flight_.material.lines[0];
  EXPECT_FALSE(line.mapped);
  EXPECT_EQ(line.views.size(), 16U);
  EXPECT_TRUE(std::is_sorted(line.views.begin(), line.views.end(),
                             [](const LineView& a, const LineView& b) { return a.keyframe < b.keyframe; }));
  EXPECT_LT(evidence(line).sigma_distance_m, evidence(tracked).sigma_distance_m);
}

TEST_F(DensifierTest, NewLinesGetIdsOfTheirOwn) {
  const std::vector<Segment3> segments = flight_.someSegments();
  for (const Segment3& segment : segments) flight_.show(segment);
  LineRecord unknown;
  unknown.id = 77;
  flight_.material.lines = {unknown};
  densify();
  ASSERT_EQ(flight_.material.lines.size(), 13U);
  for (std::size_t i = 1; i < 13; ++i) EXPECT_EQ(flight_.material.lines[i].id, 77 + i);
}

TEST_F(DensifierTest, WhatViewsLeaveOpenIsLeftToParallelLines) {
  // a flight along x shows neither the direction nor the depth of what runs along x
  for (std::size_t k = 0; k < 16; ++k)
    flight_.material.keyframes[k].T_w_b.p = {0.1 * static_cast<double>(k), 0.004 * static_cast<double>(k % 3), 0};
  for (PointRecord& point : flight_.material.points)
    for (PointView& view : point.views)
      view.px = flight_.pixelOf(flight_.material.keyframes[view.keyframe], point.p_w).cast<float>();
  flight_.show({{-0.2, 0.5, 5}, {0.8, 0.52, 5.02}});
  flight_.params.min_parallax_rad = 0;
  densify();
  for (const LineRecord& line : flight_.material.lines) {
    EXPECT_TRUE(line.parallel);
    EXPECT_FALSE(evidence(line).known) << "not drawn as it is";
  }
}

TEST_F(DensifierTest, AnEdgeWhoseOtherSideIsTheBrighterOneIsAnother) {
  const Segment3 segment{{-0.5, -0.3, 4.5}, {0.6, 0.2, 4.8}};
  for (const RetiredKeyframe& k : flight_.material.keyframes) {
    EdgeSegment edge = flight_.edgeOf(k, segment);
    if (k.id % 5 != 0) std::swap(edge.start_px, edge.end_px);  // of 16 images 12 agree with each other
    flight_.edges[k.t_ns].push_back(edge);
  }
  densify();
  ASSERT_EQ(flight_.material.lines.size(), 1U);
  for (const LineView& view : flight_.material.lines[0].views) EXPECT_NE(view.keyframe % 5, 0U);
}

TEST_F(DensifierTest, TheSameOnOneThreadAndOnThree) {
  for (const Segment3& segment : flight_.someSegments()) flight_.show(segment);
  flight_.showNoise(40);
  const MapMaterial before = flight_.material;
  densify(1);
  const std::vector<LineRecord> one = flight_.material.lines;
  flight_.material = before;
  densify(3);
  ASSERT_EQ(one.size(), flight_.material.lines.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].estimate.middle_w, flight_.material.lines[i].estimate.middle_w);
    EXPECT_EQ(one[i].estimate.covariance, flight_.material.lines[i].estimate.covariance);
    EXPECT_EQ(one[i].views.size(), flight_.material.lines[i].views.size());
  }
}

TEST_F(DensifierTest, AnEndedSearchKeepsWhatItHasFound) {
  for (const Segment3& segment : flight_.someSegments()) flight_.show(segment);
  double last = -1;
  const DensifyReport report = densify(1, [&](double share) {
    EXPECT_GT(share, last);
    last = share;
    return share < 0.05;
  });
  EXPECT_LT(last, 0.2);
  EXPECT_EQ(report.lines, 12) << "all are found from the first image";
}

TEST_F(DensifierTest, NothingToSearchIsNoFault) {
  flight_.edges.clear();
  EXPECT_EQ(densify().images, 0U);
  flight_.material = {};
  flight_.edges[5] = {{{1, 1}, {50, 50}, 0.3}};
  EXPECT_EQ(densify().lines, 0);
}

TEST_F(DensifierTest, AParameterOutOfRangeIsNamed) {
  flight_.params.partners = 0;
  try {
    densify();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("densification.partners"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace lintel
