// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/tracking/FrontEnd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/core/utility.hpp>
#include <set>

#include "TestImages.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using testing::kStep_ns;
using testing::Strip;
using testing::trackTurning;

FrontEndParams pointsOnly() {
  FrontEndParams params;
  params.features = "points";
  params.points.max_points = 60;
  return params;
}

FrontEndParams linesAtOnce() {
  FrontEndParams params;
  params.lines.sightings_before_use = 1;
  params.lines.detect_every_n = 1;
  return params;
}

const Eigen::Vector3d kTurnRate(0.25, -0.35, 0.5);

TEST(FrontEnd, followsPointsThroughRotationWithABiasedGyro) {
  const std::vector<testing::Scene> scenes(6, testing::blobs(3));
  const auto tracks = trackTurning(scenes, pointsOnly(), kTurnRate, {0.05, -0.05, 0.05});
  const Eigen::Quaterniond R_c5_c0 = expRotation(kTurnRate * 0.25).conjugate();
  std::map<TrackId, Eigen::Vector2d> first;
  for (const PointObservation& p : tracks.front().points) first[p.id] = p.ray.head<2>();
  EXPECT_GT(first.size(), 50u);
  std::vector<double> errors_px;
  for (const PointObservation& p : tracks.back().points) {
    if (!first.count(p.id)) continue;
    EXPECT_EQ(p.track_length, 6);
    const Eigen::Vector3d ray = R_c5_c0 * first[p.id].homogeneous();
    errors_px.push_back((ray.head<2>() / ray.z() - p.ray.head<2>()).norm() * 300);
  }
  ASSERT_GT(errors_px.size(), 40u);
  std::sort(errors_px.begin(), errors_px.end());
  EXPECT_LT(errors_px[errors_px.size() / 2], 0.5);
  EXPECT_LT(errors_px.back(), 1.5);  // five steps of 13 px each
}

TEST(FrontEnd, spreadsPointsAndKeepsIdsAscending) {
  const auto tracks = trackTurning(std::vector<testing::Scene>(4, testing::blobs(5)), pointsOnly(), kTurnRate);
  for (const FrameTracks& frame : tracks) {
    std::set<int> cells;
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
      if (i > 0) {
        EXPECT_LT(frame.points[i - 1].id, frame.points[i].id);
      }
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT((frame.points[i].px - frame.points[j].px).norm(), 12);
      cells.insert(static_cast<int>(frame.points[i].px.x() / 120) + 4 * static_cast<int>(frame.points[i].px.y() / 107));
    }
    EXPECT_EQ(cells.size(), 12u);  // 4 x 3 cells of the image
  }
}

TEST(FrontEnd, tracksGoOnAfterImagesThatShowNothing) {
  const testing::Scene texture = testing::blobs(3);
  const testing::Scene black = [](const Eigen::Vector2d&) { return 0.0; };
  const auto tracks =
      trackTurning({texture, texture, texture, black, black, texture, texture}, linesAtOnce(), kTurnRate);
  EXPECT_TRUE(tracks[3].points.empty());
  EXPECT_TRUE(tracks[4].points.empty());
  std::set<TrackId> before;
  for (const PointObservation& point : tracks[2].points) before.insert(point.id);
  ASSERT_GT(before.size(), 20u);
  std::size_t kept = 0;
  for (const PointObservation& point : tracks[5].points) kept += before.count(point.id);
  EXPECT_GT(10 * kept, 8 * before.size()) << kept << " of " << before.size();
}

TEST(FrontEnd, followsALineAndKeepsItsEnds) {
  const Strip strip{{-0.35, -0.1}, {0.3, 0.12}, 0.03};
  const auto tracks = trackTurning(std::vector<testing::Scene>(6, testing::strips({strip})), linesAtOnce(), kTurnRate);
  const Eigen::Quaterniond R_c5_c0 = expRotation(kTurnRate * 0.25).conjugate();
  ASSERT_EQ(tracks.front().lines.size(), 2u);  // both edges of the strip
  ASSERT_EQ(tracks.back().lines.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const LineObservation &before = tracks.front().lines[i], &after = tracks.back().lines[i];
    EXPECT_EQ(before.id, after.id);
    EXPECT_EQ(after.track_length, 6);
    const Eigen::Vector3d start = R_c5_c0 * before.start, end = R_c5_c0 * before.end;
    const Eigen::Vector3d seen = after.start.cross(after.end);
    EXPECT_LT(std::abs(seen.dot(start / start.z())) / seen.head<2>().norm() * 300, 0.5);
    EXPECT_LT(std::abs(seen.dot(end / end.z())) / seen.head<2>().norm() * 300, 0.5);
    EXPECT_LT((start / start.z() - after.start).norm() * 300, 12);
    EXPECT_LT((end / end.z() - after.end).norm() * 300, 12);
  }
}

TEST(FrontEnd, aLineKeepsItsNameWhenSplitAndCut) {
  const Strip strip{{-0.5, -0.1}, {0.5, 0.12}, 0.03};
  const auto whole = testing::strips({strip});
  const auto split = testing::strips({strip}, [](const Eigen::Vector2d& x) { return std::abs(x.x()) < 0.03; });
  const auto cut = testing::strips({strip}, [](const Eigen::Vector2d& x) { return x.x() > 0.1; });
  const auto tracks = trackTurning({whole, split, split, cut, cut, whole, whole, whole}, linesAtOnce(), {0.1, 0.1, 0});
  std::set<TrackId> ids;
  for (const FrameTracks& frame : tracks)
    for (const LineObservation& line : frame.lines)
      if ((line.end - line.start).normalized().cwiseAbs().x() > 0.9) ids.insert(line.id);
  EXPECT_EQ(ids.size(), 2u);
  const auto length = [](const LineObservation& line) { return (line.end - line.start).norm(); };
  EXPECT_LT(length(tracks[4].lines.front()), 0.75);
  EXPECT_GT(length(tracks[7].lines.front()), 0.9);  // grown back
}

TEST(FrontEnd, parallelEdgesAtDifferentDepthsThatCrossKeepTheirNames) {
  // Two posts, each bright to its right, before a wall with texture. The camera moves sideways, and the near post's
  // edge passes over the far one's.
  const auto post = [](double x, double width, double grey) {
    return [=](const Eigen::Vector2d& at) -> std::optional<double> {
      if (at.x() < x || at.x() > x + width) return std::nullopt;
      return grey;
    };
  };
  const auto wall = testing::blobs(11);
  const double near_x = -0.35, far_x = -0.15;
  const std::vector<testing::Layer> layers = {
      {2.0, post(near_x, 0.08, 150)},
      {3.5, post(far_x, 0.5, 200)},
      {6.0, [&](const Eigen::Vector2d& at) -> std::optional<double> { return 0.4 * wall(at); }}};
  const Rig rig = testing::testRig();
  FrontEnd front_end(rig, linesAtOnce());
  std::map<TrackId, std::set<char>> seen_on;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d p_w(-0.05 * i, 0.002 * i, 0);
    const std::int64_t t_ns = i * kStep_ns;
    const auto tracks = front_end.process(testing::renderLayers(rig, layers, t_ns, p_w),
                                          testing::constantRate(t_ns - kStep_ns, t_ns, {0, 0, 0}));
    const double near_now = near_x - p_w.x() / 2.0, far_now = far_x - p_w.x() / 3.5;
    if (std::abs(near_now - far_now) * 300 < 6) continue;
    for (const LineObservation& line : tracks.lines) {
      const double x = 0.5 * (line.start.x() + line.end.x());
      if (std::abs(line.end.x() - line.start.x()) * 300 > 3) continue;
      if (std::abs(x - near_now) * 300 < 2) seen_on[line.id].insert('n');
      if (std::abs(x - far_now) * 300 < 2) seen_on[line.id].insert('f');
    }
  }
  std::set<char> followed;
  for (const auto& [id, edges] : seen_on) {
    EXPECT_EQ(edges.size(), 1u) << "line " << id << " was on both edges";
    followed.insert(edges.begin(), edges.end());
  }
  EXPECT_EQ(followed.size(), 2u);
}

TEST(FrontEnd, anEdgeWhoseContrastTurnsRoundIsAnotherLine) {
  const Strip strip{{-0.35, -0.1}, {0.3, 0.12}, 0.03};
  const auto bright = testing::strips({strip}, {}, 60, 180), dark = testing::strips({strip}, {}, 180, 60);
  const auto tracks = trackTurning({bright, bright, bright, dark, dark, dark}, linesAtOnce(), {0.1, 0.1, 0});
  std::set<TrackId> before;
  for (const LineObservation& line : tracks[2].lines) before.insert(line.id);
  EXPECT_EQ(before.size(), 2u);
  ASSERT_FALSE(tracks.back().lines.empty());
  for (const LineObservation& line : tracks.back().lines) EXPECT_EQ(before.count(line.id), 0u);
}

TEST(FrontEnd, aNeighbouringEdgeIsAnotherLineUnlessItLooksTheSame) {
  // Three parallel edges keep the step's typical motion small; the middle one is 2.6 px (0.0087) further down in the
  // end. They cross the whole image: corners would move with it.
  const auto scene = [](double y, double dark, double bright) {
    return [=](const Eigen::Vector2d& x) {
      if (x.y() > y && x.y() < 0.12) return bright;
      return x.y() > -0.12 && x.y() <= y ? dark : 40.0;
    };
  };
  const auto before = scene(0, 90, 140), same = scene(0.0087, 95, 145), other = scene(0.0087, 140, 220);
  const auto middleId = [](const FrameTracks& tracks) -> TrackId {
    for (const LineObservation& line : tracks.lines)
      if (std::abs(line.start_px.y() - 160) < 6 && std::abs(line.end_px.y() - 160) < 6) return line.id;
    return 0;
  };
  for (const bool looks_the_same : {true, false}) {
    const auto tracks =
        trackTurning({before, before, before, before, looks_the_same ? same : other}, linesAtOnce(), {0, 0, 0});
    const TrackId id = middleId(tracks[3]);
    ASSERT_NE(id, 0u);
    EXPECT_EQ(middleId(tracks[4]) == id, looks_the_same);
  }
}

TEST(FrontEnd, publishesALineOnlyWhenSeenTwice) {
  FrontEndParams params = linesAtOnce();
  params.lines.sightings_before_use = 2;
  const Strip strip{{-0.35, -0.1}, {0.3, 0.12}, 0.03};
  const auto tracks = trackTurning(std::vector<testing::Scene>(3, testing::strips({strip})), params, {0, 0, 0});
  EXPECT_TRUE(tracks[0].lines.empty());
  ASSERT_EQ(tracks[1].lines.size(), 2u);
  EXPECT_EQ(tracks[1].lines[0].track_length, 1);
}

TEST(FrontEnd, descriptorModeMatchesLines) {
  FrontEndParams params = linesAtOnce();
  params.lines.mode = "descriptor";
  const Strip strip{{-0.35, -0.1}, {0.3, 0.12}, 0.03}, other{{-0.2, 0.3}, {0.0, -0.3}, 0.05};
  const auto tracks =
      trackTurning(std::vector<testing::Scene>(3, testing::strips({strip, other})), params, {0.1, 0.1, 0});
  std::set<TrackId> first, last;
  for (const LineObservation& line : tracks.front().lines) first.insert(line.id);
  for (const LineObservation& line : tracks.back().lines)
    if (line.track_length == 3) last.insert(line.id);
  EXPECT_GE(first.size(), 3u);
  EXPECT_GE(last.size(), 3u);
}

bool same(const FrameTracks& a, const FrameTracks& b) {
  if (a.points.size() != b.points.size() || a.lines.size() != b.lines.size()) return false;
  for (std::size_t i = 0; i < a.points.size(); ++i)
    if (a.points[i].id != b.points[i].id || a.points[i].px != b.points[i].px) return false;
  for (std::size_t i = 0; i < a.lines.size(); ++i)
    if (a.lines[i].id != b.lines[i].id || a.lines[i].start != b.lines[i].start || a.lines[i].end != b.lines[i].end)
      return false;
  return true;
}

TEST(FrontEnd, givesTheSameOnAnyNumberOfThreads) {
  const int threads = cv::getNumThreads();
  std::vector<std::vector<FrameTracks>> runs;
  const auto blobs = testing::blobs(7);
  const auto strip = testing::strips({{{-0.35, -0.1}, {0.3, 0.12}, 0.05}}, {}, 0, 1);
  const testing::Scene scene = [&](const Eigen::Vector2d& x) { return strip(x) > 0 ? 240.0 : 0.5 * blobs(x); };
  for (const int n : {1, 3}) {
    cv::setNumThreads(n);
    runs.push_back(trackTurning(std::vector<testing::Scene>(4, scene), linesAtOnce(), kTurnRate));
  }
  cv::setNumThreads(threads);
  for (std::size_t i = 0; i < runs[0].size(); ++i) EXPECT_TRUE(same(runs[0][i], runs[1][i])) << "frame " << i;
  EXPECT_FALSE(runs[0].back().lines.empty());
}

TEST(FrontEnd, toleratesMissingGyro) {
  const Rig rig = testing::testRig();
  FrontEnd front_end(rig, pointsOnly());
  for (int i = 0; i < 3; ++i) {
    const Eigen::Quaterniond R_c_w = expRotation(kTurnRate * 0.02 * i).conjugate();
    front_end.process(testing::renderScene(rig, testing::blobs(3), i * kStep_ns, R_c_w), {});
  }
  EXPECT_EQ(front_end.statistics().frames_without_gyro, 2);
  EXPECT_GT(front_end.statistics().points.tracked, 80);
}

TEST(FrontEnd, namesWhatIsWrong) {
  FrontEndParams params;
  params.lines.mode = "magic";
  EXPECT_THROW(FrontEnd(testing::testRig(), params), std::invalid_argument);
  params = {};
  params.points.window_px = 0;
  EXPECT_THROW(FrontEnd(testing::testRig(), params), std::invalid_argument);

  const Rig rig = testing::testRig();
  FrontEnd front_end(rig, {});
  const Frame frame = testing::renderScene(rig, testing::blobs(1), 0);
  front_end.process(frame, {});
  EXPECT_THROW(front_end.process(frame, {}), std::invalid_argument);  // not later
  Rig smaller = rig;
  smaller.camera.width = 320;
  EXPECT_THROW(front_end.process(testing::renderScene(smaller, testing::blobs(1), kStep_ns), {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace lintel
