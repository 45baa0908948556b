// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowMove.h"

#include <gtest/gtest.h>

#include <cmath>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "window/OutlierRejection.h"

namespace lintel {
namespace {

using namespace test;

TEST(WindowMove, NoLandmarkIsLostByAMoveOfFiveMetresAndAQuarterTurn) {
  const EstimatorParams params;
  SlidingWindow window = trueWindow(fly(perfectImu()), 20, 8);
  triangulatePoints(window, params.landmarks, params.factors.point_sigma_px);
  triangulateLines(window, params);
  const Pose T{Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())), {3, -4, 0}};
  const SlidingWindow before = window;
  moveWindow(window, T);

  int points = 0, lines = 0;
  for (const auto& [id, track] : window.points) {
    if (!track.triangulated) continue;
    const PointTrack& former = before.points.at(id);
    EXPECT_NEAR(reprojectionError(window, track), reprojectionError(before, former), 1e-6);
    const Eigen::Vector3d p_w = before.positionOf(former);
    EXPECT_LT((window.positionOf(track) - T * p_w).norm(), 1e-9 * (1 + p_w.norm()));
    ++points;
  }
  for (const auto& [id, track] : window.lines)
    if (track.triangulated && !track.degenerate()) {
      EXPECT_NEAR(lineError(window, track), lineError(before, before.lines.at(id)), 1e-6);
      ++lines;
    }
  EXPECT_GT(points, 50);
  EXPECT_GT(lines, 5);
  EXPECT_EQ(rejectOutliers(window, params.landmarks), 0);
  for (std::size_t k = 0; k < window.frames.size(); ++k)
    EXPECT_LT((velocityOf(window.frames[k].motion.data()) - T.q * velocityOf(before.frames[k].motion.data())).norm(),
              1e-12);
}

}  // namespace
}  // namespace lintel
