// SPDX-License-Identifier: BSD-3-Clause
#include "RunAlignment.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

Pose yawed(double yaw, const Eigen::Vector3d& p) { return {expRotation({0, 0, yaw}), p}; }

const auto kAnything = [](int, int, const Pose&) { return true; };

class RunAlignmentTest : public testing::Test {
 protected:
  /// Pairs of keyframes of two runs; each has the truth with an error of up to 5 cm, and tilts by half a degree.
  void add(int n, int earlier_run, int later_run, const Pose& earlier_from_later) {
    for (int i = 0; i < n; ++i) {
      const double s = i % 2 == 0 ? 1 : -1;
      RunPair pair;
      pair.earlier_run = earlier_run, pair.later_run = later_run, pair.later = next_++;
      pair.p_later = {0.1 * i, 2, 1};
      const Pose error{expRotation({0.008 * s, -0.008 * s, 0.004 * s}), {0.03 * s, -0.02 * s, 0.03 * s}};
      pair.earlier_from_later = earlier_from_later;
      pair.earlier_from_later.q = pair.earlier_from_later.q * error.q;
      pair.earlier_from_later.p =
          earlier_from_later * pair.p_later + error.p - pair.earlier_from_later.q * pair.p_later;
      pair.distance_m = 3;
      pairs_.push_back(pair);
    }
  }
  std::size_t refused() const {
    std::size_t n = 0;
    for (const RunPair& pair : pairs_) n += !pair.refusal.empty();
    return n;
  }
  static void expectNear(const Pose& a, const Pose& b, double limit_m) {
    EXPECT_LT((a.p - b.p).norm(), limit_m);
    EXPECT_LT(logRotation(a.q.conjugate() * b.q).norm(), 0.01);
  }

  std::vector<RunPair> pairs_;
  std::size_t next_ = 0;
};

TEST_F(RunAlignmentTest, PairsThatAgreeSayHowTheWorldsLie) {
  const Pose truth = yawed(2.5, {3, -8, 0.5});
  add(10, 0, 1, truth);
  add(3, 0, 1, yawed(-1, {1, 1, 1}));  // wrong ones
  const auto alignments = alignRuns(pairs_, 4, kAnything);
  ASSERT_EQ(alignments.size(), 1u);
  EXPECT_EQ(alignments[0].run, 1);
  EXPECT_EQ(alignments[0].world, 0);
  EXPECT_EQ(alignments[0].keyframes, 10);
  expectNear(alignments[0].world_from_run, truth, 0.02);
  EXPECT_NEAR((alignments[0].world_from_run.q * Eigen::Vector3d::UnitZ()).z(), 1, 1e-12) << "all know the vertical";
  EXPECT_EQ(refused(), 3u);
}

TEST_F(RunAlignmentTest, TooFewSayNothing) {
  add(3, 0, 1, yawed(1, {1, 2, 3}));
  EXPECT_TRUE(alignRuns(pairs_, 4, kAnything).empty());
  EXPECT_EQ(refused(), 3u);
}

TEST_F(RunAlignmentTest, RoomsThatLookAlikeFitInTwoWays) {
  add(10, 0, 1, yawed(0, {1, 2, 0}));
  add(7, 0, 1, yawed(0, {11, 2, 0}));
  EXPECT_TRUE(alignRuns(pairs_, 4, kAnything).empty());
  EXPECT_EQ(refused(), 17u);
  EXPECT_EQ(pairs_[0].refusal, "the two pieces fit in more than one way");
}

TEST_F(RunAlignmentTest, WhatTheFlightCannotHaveDoneIsRefused) {
  add(10, 0, 1, yawed(0, {100, 0, 0}));
  const auto nearBy = [](int, int, const Pose& T) { return T.p.norm() < 10; };
  EXPECT_TRUE(alignRuns(pairs_, 4, nearBy).empty());
  EXPECT_EQ(refused(), 10u);
}

TEST_F(RunAlignmentTest, RunsThatHangTogetherShareTheWorldOfTheFirst) {
  const Pose one_from_two = yawed(1, {4, 0, 0}), zero_from_two = yawed(-2, {0, 5, 1});
  add(6, 1, 2, one_from_two);
  add(9, 0, 2, zero_from_two);
  add(5, 3, 4, yawed(0.5, {1, 1, 1}));
  add(5, 0, 1, yawed(0.3, {9, 9, 9}));  // contradicts the way by run 2, which has more
  const auto alignments = alignRuns(pairs_, 4, kAnything);
  ASSERT_EQ(alignments.size(), 3u);
  EXPECT_EQ(alignments[0].run, 1);
  EXPECT_EQ(alignments[0].world, 0);
  expectNear(alignments[0].world_from_run, zero_from_two * one_from_two.inverse(), 0.1);
  EXPECT_EQ(alignments[1].run, 2);
  EXPECT_EQ(alignments[1].world, 0);
  expectNear(alignments[1].world_from_run, zero_from_two, 0.05);
  EXPECT_EQ(alignments[2].run, 4);
  EXPECT_EQ(alignments[2].world, 3);
  EXPECT_EQ(refused(), 5u);
  EXPECT_FALSE(pairs_.back().refusal.empty());
}

}  // namespace
}  // namespace lintel
