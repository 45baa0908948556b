// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/SlidingWindow.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"

namespace lintel {
namespace {

using namespace test;

SlidingWindow sample() {
  SlidingWindow window = windowAt({at(0, 0, 0), at(0.4, 0, 0), at(0.8, 0, 0), at(1.2, 0, 0)});
  for (FrameId k = 0; k < 4; ++k) {
    seePoint(window, 7, k, {0.5, 0.2, 4});
    seeLine(window, 9, k, {{0.2, -0.8, 4}, {0.3, 0.8, 4}});
  }
  triangulatePoints(window, {}, 1);
  triangulateLines(window, {});
  return window;
}

TEST(SlidingWindow, AddFrameKeepsWhatTheFrameSaw) {
  const Rig rig = eurocRig();
  SlidingWindow window(rig);
  FrameTracks tracks;
  PointObservation point;
  point.id = 5;
  point.px = {100, 200};
  point.ray = rig.camera.ray(point.px);
  tracks.points = {point};
  LineObservation line;
  line.id = 6;
  line.start_px = {10, 20};
  line.end_px = {300, 40};
  line.sigma_px = 0.3;
  tracks.lines = {line};
  WindowFrame frame;
  frame.id = 3;
  window.addFrame(frame, tracks);
  ASSERT_EQ(window.points.at(5).sightings.size(), 1u);
  EXPECT_EQ(window.points.at(5).sightings[0].frame, 3u);
  EXPECT_EQ(window.points.at(5).sightings[0].px, point.px);
  EXPECT_EQ(window.points.at(5).sightings[0].observation.ray, point.ray);
  ASSERT_EQ(window.lines.at(6).sightings.size(), 1u);
  EXPECT_EQ(window.lines.at(6).sightings[0].end_px, line.end_px);
  EXPECT_EQ(window.lines.at(6).sightings[0].sigma_px, 0.3);
}

TEST(SlidingWindow, AnEstimateStaysWhereItIsWhenItsFirstFrameLeaves) {
  SlidingWindow window = sample();
  const Eigen::Vector3d p_w = window.positionOf(window.points.at(7));
  const PluckerLine line_w = lineInWorld(window.lines.at(9));
  window.removeFrame(0, true);
  EXPECT_LT((window.positionOf(window.points.at(7)) - p_w).norm(), 1e-12);
  EXPECT_LT((p_w - Eigen::Vector3d(0.5, 0.2, 4)).norm(), 1e-9);
  EXPECT_EQ(lineInWorld(window.lines.at(9)).nearestPoint(), line_w.nearestPoint());
  EXPECT_NEAR(reprojectionError(window, window.points.at(7)), 0, 1e-6);
}

TEST(SlidingWindow, SightingsOfAKeyframeAreRememberedOthersForgotten) {
  SlidingWindow window = sample();
  window.removeFrame(0, true);
  window.removeFrame(2, false);
  EXPECT_FALSE(window.contains(0));
  EXPECT_TRUE(window.contains(1));
  for (const auto frames :
       {window.frames.size(), window.points.at(7).sightings.size(), window.lines.at(9).sightings.size()})
    EXPECT_EQ(frames, 2u);
  ASSERT_EQ(window.points.at(7).former.size(), 1u);
  EXPECT_EQ(window.points.at(7).former[0].frame, 0u);
  ASSERT_EQ(window.lines.at(9).former.size(), 1u);
  EXPECT_EQ(window.lines.at(9).former[0].frame, 0u);
}

TEST(SlidingWindow, BlocksAreFoundByTheirKeys) {
  SlidingWindow window = sample();
  EXPECT_EQ(window.block({BlockKey::kPose, 2}), window.frames[2].pose.data());
  EXPECT_EQ(window.block({BlockKey::kMotion, 3}), window.frames[3].motion.data());
  EXPECT_EQ(window.block({BlockKey::kPoint, 7}), window.points.at(7).point.data());
  EXPECT_EQ(window.block({BlockKey::kLine, 9}), window.lines.at(9).line.data());
  EXPECT_EQ(window.block({BlockKey::kExtrinsics, 0}), window.extrinsics.data());
  EXPECT_EQ(window.block({BlockKey::kCorrection, 0}), window.correction.data());
  EXPECT_THROW(window.block({BlockKey::kPose, 17}), std::out_of_range);
  EXPECT_THROW(window.block({BlockKey::kPoint, 17}), std::out_of_range);
  EXPECT_THROW(window.frame(17), std::out_of_range);
}

TEST(SlidingWindow, TheCorrectionIsOnTopOfTheCalibration) {
  SlidingWindow window(eurocRig());
  window.correction << 1, 2, 3, 4, 0.01, 0.02, 0, 0;
  const Camera a = window.camera(), b = window.correctedCamera();
  EXPECT_EQ(b.fx, a.fx + 1);
  EXPECT_EQ(b.fy, a.fy + 2);
  EXPECT_EQ(b.cx, a.cx + 3);
  EXPECT_EQ(b.cy, a.cy + 4);
  EXPECT_EQ(b.lens[0], a.lens[0] + 0.01);
  EXPECT_EQ(b.lens[1], a.lens[1] + 0.02);
}

TEST(SlidingWindow, ObservationsFollowALargeCorrection) {
  SlidingWindow window = sample();
  window.removeFrame(0, true);
  window.correction << 15, 10, -8, 5, 0.2, -0.05, 0, 0;
  window.relinearise();
  const Camera camera = window.correctedCamera();
  const auto expectAt = [&](const RayObservation& o, const Eigen::Vector2d& px) {
    EXPECT_LT((o.corrected(window.correction.data()) - camera.ray(px)).norm(), 1e-9);
  };
  const PointTrack& point = window.points.at(7);
  const LineTrack& line = window.lines.at(9);
  ASSERT_EQ(point.sightings.size(), 3u);
  ASSERT_EQ(line.sightings.size(), 3u);
  for (const PointSighting& s : point.sightings) expectAt(s.observation, s.px);
  for (const LineSighting& s : line.sightings) {
    const auto [start, end] = makeLineEnds(window.camera(), s.start_px, s.end_px, window.correction);
    EXPECT_EQ(s.start.ray, start.ray);
    EXPECT_EQ(s.end.ray, end.ray);
    EXPECT_LT((start.ray - camera.ray(s.start_px)).norm(), 2e-3) << "the best fit to the edge is another one";
    EXPECT_GT((start.ray - camera.ray(s.start_px)).norm(), 1e-6);
  }
}

TEST(SlidingWindow, WithinWhatIsNotLinearisedAnewTheFirstOrderIsGood) {
  const Camera camera = eurocRig().camera;
  for (const Eigen::Vector2d& px : {Eigen::Vector2d(5, 5), Eigen::Vector2d(40, 60), Eigen::Vector2d(745, 475)})
    for (const double sign : {-1.0, 1.0}) {
      CorrectionBlock limit;  // the signs that add up
      limit << -0.22, -0.22, 0.22, 0.22, -0.00074, -0.00074, 0, 0;
      limit *= sign;
      const Camera corrected = correctedCamera(camera, limit.data());
      EXPECT_LT((corrected.project(makeObservation(camera, px).corrected(limit.data())) - px).norm(), 0.05);
      SlidingWindow window = sample();
      const Eigen::Vector3d before = window.points.at(7).sightings[0].observation.ray;
      window.correction = limit;
      window.relinearise();
      EXPECT_EQ(window.points.at(7).sightings[0].observation.ray, before) << "within the limits";
      window.correction *= 1.1;
      window.relinearise();
      EXPECT_NE(window.points.at(7).sightings[0].observation.ray, before) << "beyond them";
    }
}

TEST(MakeObservation, CorrectionJacobianIsTheNumericOne) {
  const Camera camera = eurocRig().camera;
  for (const Eigen::Vector2d& px : {Eigen::Vector2d(370, 250), Eigen::Vector2d(40, 60), Eigen::Vector2d(700, 430)}) {
    const RayObservation o = makeObservation(camera, px);
    const auto normalisedWith = [&](const CorrectionBlock& c) -> Eigen::Vector2d {
      return correctedCamera(camera, c.data()).normalise(px);
    };
    for (int i = 0; i < kIntrinsicsSize; ++i) {
      const double step = i < 4 ? 1e-3 : 1e-6;
      CorrectionBlock plus = CorrectionBlock::Zero(), minus = CorrectionBlock::Zero();
      plus[i] = step;
      minus[i] = -step;
      const Eigen::Vector2d numeric = (normalisedWith(plus) - normalisedWith(minus)) / (2 * step);
      EXPECT_LT((o.correction_jacobian.col(i) - numeric).norm(), 1e-7 + 1e-5 * numeric.norm()) << "component " << i;
    }
    CorrectionBlock small;
    small << 0.5, -0.5, 0.3, 0.2, 1e-3, -1e-3, 0, 0;
    EXPECT_LT((o.corrected(small.data()).head<2>() - normalisedWith(small)).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace lintel
