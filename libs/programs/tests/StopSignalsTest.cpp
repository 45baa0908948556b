// SPDX-License-Identifier: BSD-3-Clause
#include "StopSignals.h"

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

namespace lintel {
namespace {

TEST(StopSignals, NotesTheFirst) {
  for (const auto& [signal, name] : {std::pair<int, const char*>{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}}) {
    const StopSignals stop;
    EXPECT_FALSE(stop.asked());
    EXPECT_NO_THROW(stop.check());
    std::raise(signal);
    EXPECT_TRUE(stop.asked());
    EXPECT_EQ(stop.name(), name);
    EXPECT_EQ(stop.exitCode(), 128 + signal);
    EXPECT_THROW(stop.check(), Stopped);
  }
}

TEST(StopSignalsDeathTest, ASecondOneEndsAtOnce) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        const StopSignals stop;
        std::raise(SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        std::raise(SIGTERM);
      },
      testing::KilledBySignal(SIGTERM), "");
}

// timeout(1) sends its signal to the program and then to the program's group: twice to the program.
TEST(StopSignals, TwoTogetherAreOneWish) {
  const StopSignals stop;
  sigset_t both, before;
  sigemptyset(&both);
  sigaddset(&both, SIGINT);
  sigaddset(&both, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &both, &before);
  std::raise(SIGINT);
  std::raise(SIGTERM);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);  // both are delivered now
  EXPECT_TRUE(stop.asked());
}

TEST(StopSignals, WhatWasIgnoredStaysIgnored) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  {
    const StopSignals stop;
    std::raise(SIGHUP);
    EXPECT_FALSE(stop.asked());
  }
  std::signal(SIGHUP, before);
}

TEST(StopSignals, GivesTheHandlersBack) {
  { const StopSignals stop; }
  struct sigaction now {};
  sigaction(SIGINT, nullptr, &now);
  EXPECT_EQ(now.sa_handler, SIG_DFL);
}

}  // namespace
}  // namespace lintel
