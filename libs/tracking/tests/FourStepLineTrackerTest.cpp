// SPDX-License-Identifier: BSD-3-Clause
#include "FourStepLineTracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "TestImages.h"

namespace lintel {
namespace {

using testing::Strip;
using testing::trackTurning;

FrontEndParams withMode(const std::string& mode) {
  FrontEndParams params;
  params.lines.mode = mode;
  params.lines.detector = "lsd";
  return params;
}

/// Identities of the long lines of some frames.
std::set<TrackId> longLines(const std::vector<FrameTracks>& tracks) {
  std::set<TrackId> ids;
  for (const FrameTracks& frame : tracks)
    for (const LineObservation& line : frame.lines)
      if ((line.end - line.start).norm() > 0.25) ids.insert(line.id);
  return ids;
}

/// How many lines are where they were predicted.
int predicted(const FrameTracks& tracks) {
  return static_cast<int>(std::count_if(tracks.lines.begin(), tracks.lines.end(),
                                        [](const LineObservation& line) { return !line.detected; }));
}

const Strip kStrip{{-0.5, -0.1}, {0.5, 0.12}, 0.03};
const Eigen::Vector3d kRate(0.1, 0.1, 0);

TEST(FourStepLineTracker, aLineThatIsSplitOrCutKeepsItsName) {
  const auto whole = testing::strips({kStrip});
  const auto split = testing::strips({kStrip}, [](const Eigen::Vector2d& x) { return std::abs(x.x()) < 0.04; });
  const auto cut = testing::strips({kStrip}, [](const Eigen::Vector2d& x) { return x.x() > -0.1 && x.x() < 0.06; });
  const std::vector<testing::Scene> scenes{whole, whole, split, split, whole, cut, whole, whole};
  EXPECT_EQ(longLines(trackTurning(scenes, withMode("four_steps"), kRate)).size(), 2U) << "both edges of the strip";
  EXPECT_GT(longLines(trackTurning(scenes, withMode("descriptor"), kRate)).size(), 2U) << "what the steps are for";
}

TEST(FourStepLineTracker, whatReplacesACutLineHasItsFormerLength) {
  const auto whole = testing::strips({kStrip});
  const auto split = testing::strips({kStrip}, [](const Eigen::Vector2d& x) { return std::abs(x.x()) < 0.04; });
  const auto tracks = trackTurning({whole, whole, split}, withMode("four_steps"), kRate);
  ASSERT_EQ(tracks.back().lines.size(), 2U) << "no piece is a line of its own";
  for (const LineObservation& line : tracks.back().lines) {
    EXPECT_GT((line.end - line.start).norm(), 0.95);
    EXPECT_FALSE(line.detected);
    EXPECT_EQ(line.track_length, 3);
  }
}

TEST(FourStepLineTracker, aDetectionThatIsWholeIsTaken) {
  const auto tracks =
      trackTurning(std::vector<testing::Scene>(3, testing::strips({kStrip})), withMode("four_steps"), {0, 0, 0});
  ASSERT_EQ(tracks.back().lines.size(), 2U);
  for (const LineObservation& line : tracks.back().lines) EXPECT_TRUE(line.detected);
}

TEST(FourStepLineTracker, aPredictionThatLooksOtherwiseIsNotTaken) {
  const testing::Scene strip = testing::strips({kStrip}), other = testing::blobs(3);
  FrontEndParams any = withMode("four_steps"), alike = any;
  any.lines.descriptor_distance = 256;
  alike.lines.descriptor_distance = 30;
  const std::vector<testing::Scene> scenes{strip, strip, other};
  EXPECT_EQ(predicted(trackTurning(scenes, any, {0, 0, 0}).back()), 2);
  EXPECT_EQ(predicted(trackTurning(scenes, alike, {0, 0, 0}).back()), 0);
}

TEST(FourStepLineTracker, aLineThatIsNeverDetectedAgainEnds) {
  FrontEndParams params = withMode("four_steps");
  params.lines.max_frames_without_detection = 3;
  params.lines.min_length_px = 70;
  const auto whole = testing::strips({kStrip});
  const auto pieces = testing::strips({kStrip}, [](const Eigen::Vector2d& x) {
    return std::fmod(x.x() + 1, 0.2) < 0.05;  // of 45 px each
  });
  const auto tracks = trackTurning({whole, whole, pieces, pieces, pieces, pieces, pieces}, params, {0, 0, 0});
  EXPECT_EQ(tracks[4].lines.size(), 2U);
  EXPECT_TRUE(tracks[5].lines.empty());
}

}  // namespace
}  // namespace lintel
