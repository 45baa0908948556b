// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/StartTries.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "lintel/estimator/WindowUpdate.h"

namespace lintel {
namespace {

using ::testing::ElementsAre;

/// Tries in so many frames when each fails.
int triesIn(int frames, const std::string& reason, StartTries& tries) {
  int count = 0;
  for (int i = 0; i < frames; ++i) {
    if (!tries.due()) continue;
    ++count;
    tries.failed(reason);
  }
  return count;
}

TEST(StartTries, EveryFifthFrameWithAFullBuffer) {
  StartTries tries;
  EXPECT_EQ(triesIn(6000, "waiting for parallax", tries), 1200);
  EXPECT_FALSE(tries.forScale());
}

TEST(StartTries, WhileTheBufferGrowsItIsLongerByATenthEachTime) {
  StartTries tries;
  std::vector<std::size_t> tried;
  for (std::size_t frames = 5; frames <= 44; ++frames) {
    if (!tries.due()) continue;
    tried.push_back(frames);
    tries.failedWhileGrowing(frames, kScaleUnknown);
  }
  EXPECT_THAT(tried, ElementsAre(5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 22, 24, 26, 28, 30, 33, 36,
                                 39, 42));
  EXPECT_EQ(tries.reason(), kScaleUnknown);
}

TEST(StartTries, TheLongerTheScaleStaysUnknownTheFewer) {
  StartTries tries;
  EXPECT_EQ(triesIn(40, kScaleUnknown, tries), 8) << "as always in the first seconds";
  EXPECT_TRUE(tries.forScale());
  EXPECT_EQ(tries.reason(), kScaleUnknown);
  EXPECT_LT(triesIn(6000, kScaleUnknown, tries), 70) << "of ten minutes";
  int waited = 0;
  while (!tries.due()) ++waited;
  EXPECT_LE(waited, 0.11 * 6040) << "a motion that shows it is not missed by more than a tenth";
}

TEST(StartTries, AnotherReasonEndsTheWaitForTheScale) {
  StartTries tries;
  triesIn(6000, kScaleUnknown, tries);
  while (!tries.due()) continue;
  tries.failed("waiting for parallax");
  EXPECT_EQ(triesIn(50, "waiting for parallax", tries), 10);
}

TEST(StartTries, AFullBufferInVainMayBeShorter) {
  StartTries tries;
  triesIn(15, "waiting for parallax", tries);
  EXPECT_FALSE(tries.mayBeShorter());
  triesIn(5, "too few points agree with the motion", tries);
  EXPECT_TRUE(tries.mayBeShorter());
  tries.failed(kScaleUnknown);
  EXPECT_FALSE(tries.mayBeShorter()) << "a shorter one knows it less";
}

TEST(StartTries, AfterAWrongStartSomeFramesAreWaitedFor) {
  StartTries tries;
  tries.startWasWrong();
  EXPECT_EQ(tries.reason(), "the start before was wrong");
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(tries.due()) << i;
  EXPECT_TRUE(tries.due());
}

}  // namespace
}  // namespace lintel
