// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowRetirement.h"

#include <gmock/gmock.h>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"

namespace lintel {
namespace {

using namespace test;
using testing::ElementsAre;

/// Points 1 and lines 1 are seen in frames 0 to 2, 2 in all frames; 3 in frames 0 and 1 only.
class WindowRetirementTest : public testing::Test {
 protected:
  WindowRetirementTest() : window_(windowAt({at(0, 0, 0), at(0.4, 0, 0), at(0.8, 0, 0), at(1.2, 0, 0)})) {
    see(1, 3);
    see(2, 4);
    see(3, 2);
    for (auto& [id, track] : window_.points) EXPECT_TRUE(triangulatePoint(window_, {}, 1, track));
    for (auto& [id, track] : window_.lines) EXPECT_TRUE(triangulateLine(window_, {}, track));
  }
  void see(TrackId id, FrameId frames) {
    for (FrameId k = 0; k < frames; ++k) {
      const double x = 0.3 * static_cast<double>(id);
      seePoint(window_, id, k, {x, 0.2, 4});
      seeLine(window_, id, k, {{x, -0.8, 4}, {x + 0.1, 0.8, 4}});
    }
  }
  template <class Retired>
  static std::vector<TrackId> ids(const std::vector<Retired>& retired) {
    std::vector<TrackId> result;
    result.reserve(retired.size());
    for (const Retired& r : retired) result.push_back(r.id);
    return result;
  }
  static std::vector<FrameId> framesOf(const std::vector<PointSighting>& sightings) {
    std::vector<FrameId> result;
    result.reserve(sightings.size());
    for (const PointSighting& s : sightings) result.push_back(s.frame);
    return result;
  }

  SlidingWindow window_;
  WindowUpdate update_;
};

TEST_F(WindowRetirementTest, TracksThatCanAddNothingGo) {
  retireTracks(window_, 0, true, update_);
  EXPECT_THAT(ids(update_.points), ElementsAre(3));  // 1 still has two sightings, 2 goes on
  EXPECT_THAT(ids(update_.lines), ElementsAre(3));
  EXPECT_EQ(window_.points.count(3), 0u);
  EXPECT_EQ(window_.lines.count(3), 0u);
  EXPECT_EQ(window_.points.size(), 2u);
  EXPECT_LT((update_.points[0].p_w - Eigen::Vector3d(0.9, 0.2, 4)).norm(), 1e-6);
  EXPECT_GT(update_.points[0].sigma_distance_m, 0);
  EXPECT_THAT(framesOf(update_.points[0].sightings), ElementsAre(0, 1));
  EXPECT_EQ(update_.lines[0].sightings.size(), 2u);
}

TEST_F(WindowRetirementTest, SightingsOfEarlierKeyframesAreHandedOver) {
  window_.points.at(3).former.push_back(window_.points.at(3).sightings[0]);
  window_.points.at(3).former[0].frame = 77;
  retireTracks(window_, 0, true, update_);
  ASSERT_EQ(update_.points.size(), 1u);
  EXPECT_THAT(framesOf(update_.points[0].sightings), ElementsAre(77, 0, 1));
}

TEST_F(WindowRetirementTest, SightingsOfAFrameThatWasNoKeyframeAreNot) {
  retireTracks(window_, 1, false, update_);
  ASSERT_THAT(ids(update_.points), ElementsAre(3));
  EXPECT_THAT(framesOf(update_.points[0].sightings), ElementsAre(0));
}

TEST_F(WindowRetirementTest, TracksWithoutAnEstimateSaySo) {
  window_.points.at(3).triangulated = false;
  window_.lines.at(3).triangulated = false;
  see(4, 1);  // a single sighting can never become known
  retireTracks(window_, 0, true, update_);
  ASSERT_THAT(ids(update_.points), ElementsAre(3));
  ASSERT_THAT(ids(update_.lines), ElementsAre(3));
  EXPECT_FALSE(update_.points[0].triangulated);
  EXPECT_FALSE(update_.lines[0].triangulated);
  EXPECT_THAT(framesOf(update_.points[0].sightings), ElementsAre(0, 1));
  EXPECT_EQ(update_.lines[0].sightings.size(), 2u);
  EXPECT_EQ(window_.points.count(3), 0u);
  EXPECT_EQ(window_.points.count(4), 0u);
}

TEST_F(WindowRetirementTest, KeyframesCarryTheirState) {
  window_.frames[1].motion << 1, 2, 3, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6;
  window_.frames[1].at_rest = true;
  window_.axes[3] = 0.02;  // (1, 0), row by row
  window_.mean_f = {0, 0, 9};
  window_.frames[2].motion[0] = 5;
  retireKeyframe(window_, 1, update_);
  ASSERT_EQ(update_.keyframes.size(), 1u);
  const RetiredKeyframe& keyframe = update_.keyframes[0];
  EXPECT_EQ(keyframe.id, 1u);
  EXPECT_EQ(keyframe.t_ns, window_.frames[1].t_ns);
  EXPECT_EQ(keyframe.T_w_b.p, Eigen::Vector3d(0.4, 0, 0));
  EXPECT_EQ(keyframe.v_w_b, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(keyframe.bias.gyro, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(keyframe.bias.accel, Eigen::Vector3d(0.4, 0.5, 0.6));
  EXPECT_TRUE(keyframe.at_rest);
  EXPECT_EQ(keyframe.axes.A(1, 0), 0.02);
  EXPECT_EQ(keyframe.axes.mean_f, Eigen::Vector3d(0, 0, 9));
  ASSERT_TRUE(keyframe.next) << "for what the IMU says between both, by one solve";
  EXPECT_EQ(keyframe.next->T_w_b.p, window_.frames[2].T_w_b().p);
  EXPECT_EQ(keyframe.next->v_w_b.x(), 5);
}

TEST_F(WindowRetirementTest, RetireAllHandsOverEverythingOnceAndEmpties) {
  retireAll(window_, update_);
  EXPECT_THAT(ids(update_.points), ElementsAre(1, 2, 3));
  EXPECT_THAT(ids(update_.lines), ElementsAre(1, 2, 3));
  EXPECT_THAT(ids(update_.keyframes), ElementsAre(0, 1, 2, 3));
  EXPECT_TRUE(update_.keyframes[2].next);
  EXPECT_FALSE(update_.keyframes[3].next);
  EXPECT_TRUE(window_.frames.empty() && window_.points.empty() && window_.lines.empty() && window_.priors.empty());
}

}  // namespace
}  // namespace lintel
