// SPDX-License-Identifier: BSD-3-Clause
#include "DriftCheck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace lintel {
namespace {

/// 40 points seen by a camera that moves sideways by 2 cm a frame; tracks 7 and 20 also slip down by `drift_px` a
/// frame.
std::vector<PointObservation> frame(int index, double drift_px) {
  std::vector<PointObservation> points;
  for (int i = 0; i < 40; ++i) {
    const double depth = 2 + 4 * std::fmod(i * 0.618, 1.0);
    PointObservation p;
    p.id = static_cast<TrackId>(i) + 1;
    p.ray = {-0.7 + 0.035 * i - 0.02 * index / depth, 0.4 * std::sin(1.7 * i), 1};
    if (p.id == 7 || p.id == 20) p.ray.y() += drift_px * index / 460;
    points.push_back(p);
  }
  return points;
}

std::vector<TrackId> driftingAfter(int frames, double drift_px) {
  DriftCheck check(10, {460, 1.5, 0.3, 60});
  for (int i = 0; i < frames; ++i) check.push(frame(i, drift_px), Eigen::Quaterniond::Identity());
  return check.drifting();
}

TEST(DriftCheck, findsTracksThatSlipByLittleEveryFrame) {
  EXPECT_THAT(driftingAfter(11, 0.4), ::testing::ElementsAre(7u, 20u));
  EXPECT_THAT(driftingAfter(25, 0.4), ::testing::ElementsAre(7u, 20u));
}

TEST(DriftCheck, isSilentWithoutDriftOrHistory) {
  EXPECT_THAT(driftingAfter(25, 0.0), ::testing::IsEmpty());
  EXPECT_THAT(driftingAfter(10, 0.4), ::testing::IsEmpty());
}

}  // namespace
}  // namespace lintel
