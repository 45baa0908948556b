// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/TrajectoryErrors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kSecond = 1000000000;

/// One pose a second: 1 m/s along x, looking ahead.
StampedPoses straight(int count) {
  StampedPoses poses;
  for (int i = 0; i < count; ++i)
    poses.emplace_back(i * kSecond, Pose{Eigen::Quaterniond::Identity(), Vector3d(i, 0, 0)});
  return poses;
}

/// A square of 4 m at 1 m/s, one pose a second; it comes back to its start.
StampedPoses square() {
  StampedPoses poses;
  const Vector3d sides[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  Vector3d p = Vector3d::Zero();
  for (int i = 0; i <= 16; ++i) {
    poses.emplace_back(i * kSecond, Pose{expRotation({0, 0, 0.1 * i}), p});
    if (i < 16) p += sides[i / 4];
  }
  return poses;
}

StampedPoses moved(const StampedPoses& poses, const Pose& T, double scale = 1) {
  StampedPoses result = poses;
  for (auto& [t_ns, pose] : result) {
    pose.p *= scale;
    pose = T * pose;
  }
  return result;
}

TEST(Statistics, OfFourByHand) {
  const ErrorStatistics s = statisticsOf({4, 1, 3, 2});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_DOUBLE_EQ(statisticsOf({7, 1, 3}).median, 3);
  EXPECT_DOUBLE_EQ(s.p25, 2);
  EXPECT_DOUBLE_EQ(s.p95, 4);
}

TEST(Statistics, OfNothingIsNotANumber) {
  EXPECT_EQ(statisticsOf({}).count, 0u);
  EXPECT_TRUE(std::isnan(statisticsOf({}).rmse));
}

TEST(Associate, TakesTheNearestWithinTheLimit) {
  const StampedPoses truth = {{100, {}}, {200, {}}, {300, {}}};
  const StampedPoses estimate = {{79, {}}, {80, {}}, {150, {}}, {151, {}}, {240, {}}, {320, {}}, {321, {}}};
  const auto pairs = associate(estimate, truth, 20e-9);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].estimate, 1u);
  EXPECT_EQ(pairs[0].groundtruth, 0u);
  EXPECT_EQ(pairs[1].estimate, 5u);
  EXPECT_EQ(pairs[1].groundtruth, 2u);
  const auto wide = associate(estimate, truth, 60e-9);
  ASSERT_EQ(wide.size(), 7u);
  EXPECT_EQ(wide[2].groundtruth, 0u);  // 150 is as near to 100 as to 200: the earlier one
  EXPECT_EQ(wide[3].groundtruth, 1u);
  EXPECT_TRUE(associate(estimate, {}, 1).empty());
}

TEST(TrajectoryErrors, WithoutAlignmentByHand) {
  StampedPoses estimate = straight(4);
  estimate[1].second.p += Vector3d(0, 3, 4);  // 5 m off
  estimate[3].second.p.z() = 1;
  estimate[2].second.q = expRotation({0, 0, 0.2});
  TrajectoryErrorParams params;
  params.alignment = AlignmentKind::kNone;
  const TrajectoryErrors errors = evaluateTrajectory(estimate, straight(4), params);
  EXPECT_EQ(errors.pairs, 4u);
  EXPECT_DOUBLE_EQ(errors.position_m.rmse, std::sqrt((25.0 + 1.0) / 4));
  EXPECT_DOUBLE_EQ(errors.position_m.mean, 1.5);
  EXPECT_DOUBLE_EQ(errors.position_m.median, 0.5);
  EXPECT_DOUBLE_EQ(errors.position_m.max, 5);
  EXPECT_NEAR(errors.rotation_rad.max, 0.2, 1e-15);
  EXPECT_NEAR(errors.rotation_rad.mean, 0.05, 1e-15);
  ASSERT_EQ(errors.series.size(), 4u);
  EXPECT_EQ(errors.series[1].first, kSecond);
  EXPECT_DOUBLE_EQ(errors.series[1].second, 5);
}

TEST(TrajectoryErrors, AlignmentTakesAwayTheFrameButNotTheScale) {
  const Pose T{expRotation({0.3, -1, 2}), {5, -6, 7}};
  const TrajectoryErrors same = evaluateTrajectory(moved(square(), T), square());
  EXPECT_LE(same.position_m.max, 1e-12);
  EXPECT_LE(same.rotation_rad.max, 1e-12);
  EXPECT_NEAR(same.scale, 1, 1e-12);

  const TrajectoryErrors small = evaluateTrajectory(moved(square(), T, 0.8), square());
  EXPECT_NEAR(small.scale, 1.25, 1e-12);
  EXPECT_LE(small.position_sim3_m.max, 1e-12);
  EXPECT_GT(small.position_m.rmse, 0.3);
  TrajectoryErrorParams params;
  params.alignment = AlignmentKind::kSim3;
  const TrajectoryErrors scaled = evaluateTrajectory(moved(square(), T, 0.8), square(), params);
  EXPECT_LE(scaled.position_m.max, 1e-12);
  EXPECT_EQ(scaled.relative[1].translation_m.count, 15u);  // stretches of 2 m
  EXPECT_LE(scaled.relative[1].translation_m.max, 1e-12);
}

TEST(TrajectoryErrors, RelativeErrorsOfAWrongScaleByHand) {
  TrajectoryErrorParams params;
  params.distances_m = {2, 5, 50};
  const TrajectoryErrors errors = evaluateTrajectory(moved(straight(11), {}, 1.1), straight(11), params);
  ASSERT_EQ(errors.relative.size(), 4u);
  EXPECT_EQ(errors.relative[0].translation_m.count, 9u);  // starts at 0 … 8 m
  EXPECT_NEAR(errors.relative[0].translation_m.rmse, 0.2, 1e-12);
  EXPECT_EQ(errors.relative[1].translation_m.count, 6u);
  EXPECT_NEAR(errors.relative[1].translation_m.max, 0.5, 1e-12);
  EXPECT_EQ(errors.relative[2].translation_m.count, 0u);  // the path is not that long
  EXPECT_TRUE(errors.relative[3].whole_path);
  EXPECT_DOUBLE_EQ(errors.relative[3].distance_m, 10);
  EXPECT_NEAR(errors.relative[3].translation_m.rmse, 1.0, 1e-12);
}

TEST(TrajectoryErrors, RelativeErrorsSeeHeadingDriftLocally) {
  // A heading that drifts by 0.01 rad/m: after 5 m of any stretch the heading is 0.05 rad off.
  StampedPoses estimate;
  Pose T;
  for (int i = 0; i <= 20; ++i) {
    estimate.emplace_back(i * kSecond, T);
    T = T * Pose{expRotation({0, 0, 0.01}), {1, 0, 0}};
  }
  TrajectoryErrorParams params;
  params.distances_m = {5};
  const TrajectoryErrors errors = evaluateTrajectory(estimate, straight(21), params);
  EXPECT_NEAR(errors.relative[0].rotation_rad.mean, 0.05, 1e-12);
  EXPECT_NEAR(errors.relative[0].rotation_rad.max, 0.05, 1e-12);
  EXPECT_NEAR(errors.relative.back().rotation_rad.max, 0.2, 1e-12);
}

TEST(TrajectoryErrors, StretchesDoNotLeapOverGaps) {
  StampedPoses estimate = straight(31);
  estimate.erase(estimate.begin() + 11, estimate.begin() + 20);  // nothing between 10 and 20 s
  TrajectoryErrorParams params;
  params.distances_m = {4};
  const TrajectoryErrors errors = evaluateTrajectory(estimate, straight(31), params);
  EXPECT_EQ(errors.relative[0].translation_m.count, 7u + 7u);  // starts at 0 … 6 and 20 … 26 m
}

TEST(TrajectoryErrors, CoverageLeavesGapsOut) {
  StampedPoses estimate = straight(31);
  estimate.erase(estimate.begin() + 11, estimate.begin() + 20);
  estimate.erase(estimate.begin(), estimate.begin() + 5);
  const TrajectoryErrors errors = evaluateTrajectory(estimate, straight(41));
  EXPECT_DOUBLE_EQ(errors.start_offset_s, 5);
  EXPECT_DOUBLE_EQ(errors.duration_s, 40);
  EXPECT_DOUBLE_EQ(errors.coverage_time, 15.0 / 40);  // 5 … 10 and 20 … 30 s
  EXPECT_DOUBLE_EQ(errors.coverage_path, 15.0 / 40);
}

TEST(TrajectoryErrors, HalfARunCannotLookBetterThanAWholeOne) {
  const StampedPoses truth = square();
  StampedPoses whole = truth;  // 10 cm off at every second pose
  for (std::size_t i = 0; i < whole.size(); i += 2) whole[i].second.p.z() += 0.1;
  const StampedPoses half(truth.begin(), truth.begin() + 8);  // perfect as far as it goes
  TrajectoryErrorParams params;
  params.max_gap_s = 1.5;
  const TrajectoryErrors of_whole = evaluateTrajectory(whole, truth, params),
                         of_half = evaluateTrajectory(half, truth, params);
  EXPECT_TRUE(of_whole.complete);
  EXPECT_FALSE(of_half.complete);
  EXPECT_LT(of_half.position_m.rmse, of_whole.position_m.rmse);  // what must not be compared
  EXPECT_LT(of_whole.whole_rmse_m, of_half.whole_rmse_m);
  EXPECT_NEAR(of_whole.whole_rmse_m, of_whole.position_m.rmse, 0.005);
}

TEST(TrajectoryErrors, TheWholeRecordingByHand) {
  // Truth 0 1 2 3 4 m; the estimate is right at 0 1 2 and then gone: 3 and 4 m are taken for 2 m.
  const StampedPoses truth = straight(5), estimate(truth.begin(), truth.begin() + 3);
  TrajectoryErrorParams params;
  params.alignment = AlignmentKind::kNone;
  EXPECT_NEAR(evaluateTrajectory(estimate, truth, params).whole_rmse_m, std::sqrt((1 * 1.0 + 0.5 * 4.0) / 4), 1e-12);
}

TEST(TrajectoryErrors, OnlyTheAskedPartOfTheTruthCounts) {
  TrajectoryErrorParams params;
  params.from_ns = 4 * kSecond;
  params.to_ns = 12 * kSecond;
  const StampedPoses truth = square();
  const TrajectoryErrors errors = evaluateTrajectory({truth.begin() + 4, truth.begin() + 13}, truth, params);
  EXPECT_EQ(errors.pairs, 9u);
  EXPECT_DOUBLE_EQ(errors.duration_s, 8);
  EXPECT_DOUBLE_EQ(errors.start_offset_s, 0);
  EXPECT_DOUBLE_EQ(errors.coverage_time, 1);
  EXPECT_TRUE(errors.complete);
}

TEST(TrajectoryErrors, RefusesTrajectoriesThatDoNotMeet) {
  StampedPoses later = straight(10);
  for (auto& [t_ns, pose] : later) t_ns += 1000 * kSecond;
  EXPECT_THROW(evaluateTrajectory(later, straight(10)), EvaluationError);
}

}  // namespace
}  // namespace lintel
