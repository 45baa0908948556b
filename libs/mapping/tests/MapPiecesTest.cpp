// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapPieces.h"

#include <gtest/gtest.h>

#include "TestMaterial.h"

namespace lintel {
namespace {

using namespace test;

/// Nine keyframes, the IMU leads from each to the next but not from 3 to 4; a point and a line in both pieces.
class MapPiecesTest : public testing::Test {
 protected:
  MapPiecesTest() {
    for (RetiredKeyframe& keyframe : material_.keyframes) {
      if (keyframe.id != 0 && keyframe.id != 4) keyframe.imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
      keyframe.v_w_b = {1, 0, 0};
      material_.trajectory.emplace_back(keyframe.t_ns, keyframe.T_w_b);
      material_.trajectory.emplace_back(keyframe.t_ns + 50'000'000, keyframe.T_w_b);
    }
    material_.points = {pointOf(material_, 1, {1, 0, 4}, 0, 3), pointOf(material_, 2, {3, 0, 4}, 5, 8)};
    material_.lines = {lineOf(material_, 1, {{0, 1, 4}, {2, 1, 4}}, 0, 3),
                       lineOf(material_, 2, {{2, 1, 4}, {4, 1, 4}}, 5, 8)};
    for (PointRecord& point : material_.points) point.p_w = {1, 0, 4};
    for (LineRecord& line : material_.lines) line.estimate.middle_w = {1, 0, 4};
    material_.pieces = separatePieces(material_);
  }
  MapMaterial material_ = materialAlongX(9);
};

TEST_F(MapPiecesTest, APieceBeginsWhereNoImuLeads) {
  ASSERT_EQ(material_.pieces.size(), 2u);
  EXPECT_EQ(material_.pieces[1].first_keyframe, 4u);
  EXPECT_EQ(material_.pieces[0].last_ns, material_.keyframes[3].t_ns);
  EXPECT_EQ(material_.pieces[1].first_pose, 8u);
  EXPECT_EQ(material_.pieces[1].world, 1);
  EXPECT_EQ(pieceOf(material_.pieces, 3), 0u);
  EXPECT_EQ(pieceOf(material_.pieces, 4), 1u);
  EXPECT_EQ(pieceOf(material_.pieces, 100), 1u);
  EXPECT_TRUE(separatePieces(materialAlongX(5)).empty()) << "no IMU at all";
}

TEST_F(MapPiecesTest, APieceMovesWithAllThatBelongsToIt) {
  const MapMaterial before = material_;
  const Pose T{expRotation({0, 0, M_PI / 2}), {10, 0, 0}};
  movePiece(1, T, material_);
  for (std::size_t k = 0; k < 9; ++k) {
    const Pose& was = before.keyframes[k].T_w_b;
    EXPECT_LT((material_.keyframes[k].T_w_b.p - (k < 4 ? was : T * was).p).norm(), 1e-12);
    EXPECT_LT((material_.keyframes[k].v_w_b - (k < 4 ? Eigen::Vector3d(1, 0, 0) : Eigen::Vector3d(0, 1, 0))).norm(),
              1e-12);
  }
  for (std::size_t i = 0; i < 18; ++i)
    EXPECT_LT(
        (material_.trajectory[i].second.p - (i < 8 ? before.trajectory[i].second : T * before.trajectory[i].second).p)
            .norm(),
        1e-12);
  EXPECT_EQ(material_.points[0].p_w, Eigen::Vector3d(1, 0, 4));
  EXPECT_LT((material_.points[1].p_w - Eigen::Vector3d(10, 1, 4)).norm(), 1e-12);
  EXPECT_EQ(material_.lines[0].estimate.middle_w, Eigen::Vector3d(1, 0, 4));
  EXPECT_LT((material_.lines[1].estimate.middle_w - Eigen::Vector3d(10, 1, 4)).norm(), 1e-12);
}

TEST_F(MapPiecesTest, AnotherRecordingIsPutBehind) {
  MapMaterial whole = material_;
  whole.time_offset_s = 0.002;
  material_.time_offset_s = 0.005;
  material_.keyframes[8].offset_change_s = 0.001;
  const AppendedIds ids = appendMaterial(material_, whole);
  EXPECT_EQ(whole.keyframes[8].offset_change_s, 0);
  EXPECT_NEAR(whole.keyframes[17].offset_change_s, 0.004, 1e-15) << "6 ms, of which all have 2";
  EXPECT_EQ(ids.keyframes, 9u);
  EXPECT_EQ(ids.points, 3u);
  EXPECT_EQ(ids.pieces, 2);
  ASSERT_EQ(whole.pieces.size(), 4u);
  EXPECT_EQ(whole.pieces[3].first_keyframe, 13u);
  EXPECT_EQ(whole.pieces[3].first_pose, 26u);
  EXPECT_EQ(whole.pieces[3].world, 3);
  EXPECT_EQ(whole.keyframes[17].id, 17u);
  EXPECT_EQ(whole.points[3].id, 5u);
  EXPECT_EQ(whole.points[3].views.back().keyframe, 17u);
  EXPECT_EQ(whole.lines[2].views.front().keyframe, 9u);
  EXPECT_EQ(whole.trajectory.size(), 36u);
}

}  // namespace
}  // namespace lintel
