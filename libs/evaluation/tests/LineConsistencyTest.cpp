// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/LineConsistency.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lintel {
namespace {

using Eigen::Vector3d;

constexpr double kEndSigma_m = 0.01;

/// A camera at the origin of each keyframe's body that looks along y, and an edge along x five metres away.
class LineConsistencyTest : public ::testing::Test {
 protected:
  LineConsistencyTest() {
    Camera& camera = map_.rig.camera;
    camera.width = 640, camera.height = 480, camera.fx = camera.fy = 400, camera.cx = 320, camera.cy = 240;
    Eigen::Matrix3d R_b_c;
    R_b_c << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    map_.rig.T_b_c.q = R_b_c;
    for (std::uint64_t k = 0; k < 10; ++k) {
      Pose T_w_b;
      T_w_b.p = Vector3d(0.1 * static_cast<double>(k), 0, 0.05 * static_cast<double>(k));
      const auto t_ns = static_cast<std::int64_t>(k) * 100'000'000;
      map_.keyframes.push_back({k, t_ns, T_w_b});
      truth_.emplace_back(t_ns, T_w_b);
    }
    edges_.push_back({{{-1, 5, 0}, {2, 5, 0}}, 100});
  }

  /// A line whose ends are off by so much, seen where `shown` is projected.
  void addLine(const Vector3d& off, const Segment3& shown) {
    MapLine line;
    line.segment_w = {shown.start + off, shown.end + off};
    line.sigma_distance_m = kEndSigma_m;
    for (const MapKeyframe& keyframe : map_.keyframes) {
      const Pose T_c_w = (keyframe.T_w_b * map_.rig.T_b_c).inverse();
      line.observations.push_back(
          {keyframe.id, map_.rig.camera.project(T_c_w * shown.start), map_.rig.camera.project(T_c_w * shown.end)});
    }
    map_.lines.push_back(line);
  }

  LineConsistency consistency() const { return evaluateConsistency(map_, {}, edges_, truth_); }

  LineMap map_;
  StampedPoses truth_;
  std::vector<TrueLine> edges_;
  const Segment3 edge_{{0, 5, 0}, {1, 5, 0}};
};

TEST_F(LineConsistencyTest, EndsCountByTheirSigmas) {
  addLine({0, 0.5 * kEndSigma_m, 0}, edge_);
  addLine({0, 1.5 * kEndSigma_m, 0}, edge_);
  addLine({0, 0, -1.5 * kEndSigma_m}, edge_);
  addLine({0, 5 * kEndSigma_m, 0}, edge_);
  for (const SigmaShares& shares : {consistency().near.tracked, consistency().seen.tracked}) {
    EXPECT_EQ(shares.ends, 8u);
    EXPECT_DOUBLE_EQ(shares.within_1, 0.25);
    EXPECT_DOUBLE_EQ(shares.within_2, 0.75);
  }
}

TEST_F(LineConsistencyTest, ALineBesideAnEdgeIsNotThatEdge) {
  // drawn where it is, 6 cm beside the edge: near it, but the images show it elsewhere
  addLine(Vector3d::Zero(), {{0, 5, 0.06}, {1, 5, 0.06}});
  EXPECT_EQ(consistency().near.tracked.ends, 2u);
  EXPECT_EQ(consistency().seen.tracked.ends, 0u);
}

TEST_F(LineConsistencyTest, AWrongDepthIsAnErrorOfTheEdgeThatWasSeen) {
  addLine({0, 0.25, 0}, edge_);
  EXPECT_EQ(consistency().near.tracked.ends, 0u);
  EXPECT_EQ(consistency().seen.tracked.ends, 2u);
  EXPECT_EQ(consistency().seen.tracked.within_2, 0);
}

TEST_F(LineConsistencyTest, SourcesAreApart) {
  addLine(Vector3d::Zero(), edge_);
  map_.lines.back().mapped = true;
  addLine(Vector3d::Zero(), edge_);
  map_.lines.back().mapped = map_.lines.back().constrained = true;
  EXPECT_EQ(consistency().seen.tracked.ends, 0u);
  EXPECT_TRUE(std::isnan(consistency().seen.tracked.within_2));
  EXPECT_EQ(consistency().seen.mapped.ends, 2u);
  EXPECT_EQ(consistency().seen.constrained.ends, 2u);
}

TEST_F(LineConsistencyTest, WithoutTruePosesOnlyWhatIsNear) {
  addLine(Vector3d::Zero(), edge_);
  truth_.clear();
  EXPECT_EQ(consistency().near.tracked.ends, 2u);
  EXPECT_EQ(consistency().seen.tracked.ends, 0u);
}

}  // namespace
}  // namespace lintel
