// SPDX-License-Identifier: BSD-3-Clause
#include "TrajectoryChange.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// Along a quarter of a circle of 10 m, a metre between keyframes.
std::vector<RetiredKeyframe> flight(std::uint64_t first = 0) {
  std::vector<RetiredKeyframe> keyframes;
  for (std::uint64_t i = 0; i <= 15; ++i) {
    RetiredKeyframe k;
    k.id = first + i;
    const double angle = 0.1 * static_cast<double>(i);
    k.T_w_b = {expRotation({0.1, 0.2, angle}), {10 * std::cos(angle), 10 * std::sin(angle), 1}};
    if (i > 0) k.imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{});
    keyframes.push_back(k);
  }
  return keyframes;
}

void move(const Pose& new_from_old, std::vector<RetiredKeyframe>& keyframes) {
  for (RetiredKeyframe& k : keyframes) k.T_w_b = new_from_old * k.T_w_b;
}

TEST(TrajectoryChange, PlaceAndYawOfAllAreNone) {
  const auto before = flight();
  auto after = before;
  move({expRotation({0, 0, 2.5}), {3, -40, 7}}, after);
  const TrajectoryChange change = trajectoryChange(before, after, {});
  EXPECT_LT(change.moved_m, 1e-9);
  EXPECT_LT(change.turned_rad, 1e-9);
  EXPECT_NEAR(change.travelled_m, 15 * 20 * std::sin(0.05), 1e-9);
}

TEST(TrajectoryChange, ATiltIsOne) {
  const auto before = flight();
  auto after = before;
  move({expRotation({0.05, 0, 0}), {0, 0, 0}}, after);
  const TrajectoryChange change = trajectoryChange(before, after, {});
  EXPECT_NEAR(change.turned_rad, 0.05, 2e-3);
  EXPECT_GT(change.moved_m, 0.2);
}

/// As a wrong scale does.
TEST(TrajectoryChange, ScalingMovesTheEndsByTheirDistanceFromTheMiddle) {
  std::vector<RetiredKeyframe> before(3);
  for (int i = 0; i < 3; ++i) before[i].T_w_b.p = {10.0 * i, 0, 0};
  auto after = before;
  for (RetiredKeyframe& k : after) k.T_w_b.p *= 1.1;
  EXPECT_NEAR(trajectoryChange(before, after, {}).moved_m, 1, 1e-9);
  EXPECT_LT(trajectoryChange(before, after, {}).turned_rad, 1e-9);
}

TEST(TrajectoryChange, EachWorldHasAPlaceOfItsOwn) {
  auto before = flight();
  const auto second = flight(100);
  before.insert(before.end(), second.begin(), second.end());
  auto after = before;
  for (std::size_t k = 16; k < after.size(); ++k)
    after[k].T_w_b = Pose{expRotation({0, 0, 1}), {5, 5, 5}} * after[k].T_w_b;
  MapPiece a, b;
  b.first_keyframe = 100;
  b.world = 1;
  EXPECT_LT(trajectoryChange(before, after, {a, b}).moved_m, 1e-9);
  b.world = 0;  // joined
  EXPECT_GT(trajectoryChange(before, after, {a, b}).moved_m, 2);
}

}  // namespace
}  // namespace lintel
