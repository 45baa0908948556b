// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/reporting/Progress.h"

#include <gtest/gtest.h>

#include <sstream>

namespace lintel {
namespace {

/// A clock that the test moves.
struct TestClock {
  Progress::Clock::time_point now{};
  void pass(double seconds) {
    now += std::chrono::duration_cast<Progress::Clock::duration>(std::chrono::duration<double>(seconds));
  }
  Progress::Now reader() {
    return [this] { return now; };
  }
};

TEST(ProgressTest, LinesComeEveryFiveSecondsWithRateAndTimeLeft) {
  std::ostringstream out;
  TestClock clock;
  Progress progress(out, ProgressStyle::Lines, "reading", "frames", 1000, clock.reader());
  for (int done = 1; done <= 110; ++done) {
    clock.pass(0.1);
    progress.update(static_cast<std::size_t>(done));
  }
  EXPECT_EQ(out.str(),
            "reading: 50/1000 frames, 10/s, 1 min 35 s left\nreading: 100/1000 frames, 10/s, 1 min 30 s left\n");
}

TEST(ProgressTest, BarIsRedrawnInPlaceAndRemoved) {
  std::ostringstream out;
  TestClock clock;
  {
    Progress progress(out, ProgressStyle::Bar, "reading", "frames", 8, clock.reader());
    progress.update(1);
    EXPECT_EQ(out.str(), "");  // too early
    clock.pass(0.5);
    progress.update(4);
    EXPECT_EQ(out.str(), "\rreading [############------------] 4/8 frames, 8.0/s, 1 s left");
  }
  const std::string text = out.str();
  EXPECT_EQ(text.substr(text.rfind('\r', text.size() - 2)), "\r" + std::string(62, ' ') + "\r");
}

TEST(ProgressTest, AnUnknownTotalHasNoBar) {
  std::ostringstream out;
  TestClock clock;
  Progress progress(out, ProgressStyle::Bar, "reading", "frames", 0, clock.reader());
  clock.pass(1);
  progress.update(40);
  EXPECT_EQ(out.str(), "\rreading 40 frames, 40/s");
}

TEST(ProgressTest, QuietPrintsNothing) {
  std::ostringstream out;
  TestClock clock;
  EXPECT_EQ(progressStyleFor(out, true), ProgressStyle::None);
  EXPECT_EQ(progressStyleFor(out, false), ProgressStyle::Lines);
  Progress progress(out, ProgressStyle::None, "reading", "frames", 10, clock.reader());
  clock.pass(100);
  progress.update(10);
  EXPECT_EQ(out.str(), "");
}

TEST(ProgressTest, DurationsAreForPeople) {
  EXPECT_EQ(durationText(7.6), "8 s");
  EXPECT_EQ(durationText(200), "3 min 20 s");
  EXPECT_EQ(durationText(7500), "2 h 05 min");
}

}  // namespace
}  // namespace lintel
