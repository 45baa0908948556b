// SPDX-License-Identifier: BSD-3-Clause
#include "SampleTimes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "EvenTimes.h"
#include "EvenedStamps.h"
#include "lintel/core/Frame.h"

namespace lintel {
namespace {

using test::evened;
using test::Stamps;

constexpr std::int64_t kPeriod_ns = 5'000'000, kLate_ns = 1'000'000;

/// Stamps of a 200 Hz sensor whose samples arrive `each` at a time, the last one `kLate_ns` after it was taken and up
/// to a millisecond more, `apart_ns` from each other.
Stamps arrivals(std::size_t n, std::size_t each, std::int64_t apart_ns = 100'000) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> more(0, 1e6);
  Stamps stamps(n);
  for (std::size_t i = 0; i < n; i += each) {
    const std::int64_t at_ns =
        static_cast<std::int64_t>(i + each - 1) * kPeriod_ns + kLate_ns + static_cast<std::int64_t>(more(random));
    for (std::size_t k = i; k < std::min(n, i + each); ++k)
      stamps[k] = at_ns + static_cast<std::int64_t>(k - i) * apart_ns;
  }
  return stamps;
}

TEST(SampleTimes, SamplesOfPacketsAreSpreadEvenly) {
  for (const std::int64_t apart_ns : {100'000, 0})  // 0: the packet has one stamp
    for (const std::size_t each : {2, 4, 10}) {
      const Stamps out = evened<SampleTimes>(arrivals(2000, each, apart_ns), 400);
      ASSERT_EQ(out.size(), 2000U);
      std::vector<double> late_ms;
      for (std::size_t i = 300; i + 300 < out.size(); ++i)
        late_ms.push_back(1e-6 * static_cast<double>(out[i] - static_cast<std::int64_t>(i) * kPeriod_ns));
      const auto [least, most] = std::minmax_element(late_ms.begin(), late_ms.end());
      EXPECT_LT(*most - *least, 0.5) << "packets of " << each << ": late by the same";
      EXPECT_GT(*least, 1);
    }
}

TEST(SampleTimes, SaysHowTheyCome) {
  const SampleTimes times(arrivals(400, 4));
  EXPECT_NE(times.remark().find("packets of about 4"), std::string::npos) << times.remark();
  EXPECT_NEAR(times.rate_hz(), 200, 2);
}

TEST(SampleTimes, TimesAscendFromTheFirstToTheLast) {
  const Stamps out = evened<SampleTimes>(arrivals(700, 10), 400);
  for (std::size_t i = 1; i < out.size(); ++i) EXPECT_NEAR(1e-6 * static_cast<double>(out[i] - out[i - 1]), 5, 1.5);
}

TEST(SampleTimes, WhatFollowsADropOutHasItsOwnLine) {
  Stamps stamps = arrivals(2000, 4);
  for (std::size_t i = 1000; i < stamps.size(); ++i) stamps[i] += 300'000'000;
  const Stamps out = evened<SampleTimes>(stamps, 400);
  ASSERT_EQ(out.size(), 2000U);
  EXPECT_NEAR(1e-6 * static_cast<double>(out[1000] - out[999]), 305, 3);
  EXPECT_NEAR(1e-6 * static_cast<double>(out[999] - out[998]), 5, 1);
}

/// Each sample is late by an amount of its own.
Stamps shaken(double sigma_ms) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> jitter(0, 1e6 * sigma_ms);
  Stamps stamps(2000);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    stamps[i] = static_cast<std::int64_t>(i) * kPeriod_ns + static_cast<std::int64_t>(jitter(random));
    if (i > 0) stamps[i] = std::max(stamps[i], stamps[i - 1] + 1000);
  }
  return stamps;
}

TEST(SampleTimes, StampsThatScatterAboutEvenOnesAreEvened) {
  for (const double sigma_ms : {0.7, 1.5}) {
    const Stamps out = evened<SampleTimes>(shaken(sigma_ms), 400);
    ASSERT_EQ(out.size(), 2000U);
    double squares = 0;
    for (std::size_t i = 0; i < out.size(); ++i)
      squares += std::pow(1e-6 * static_cast<double>(out[i] - static_cast<std::int64_t>(i) * kPeriod_ns), 2);
    EXPECT_LT(std::sqrt(squares / 2000), 0.15 * sigma_ms);
  }
}

TEST(SampleTimes, StampsOfTheSensorItselfAreLeft) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  Stamps even(400), missing(400), uneven(400);
  for (std::size_t i = 1; i < even.size(); ++i) {
    even[i] = even[i - 1] + kPeriod_ns;
    missing[i] = missing[i - 1] + kPeriod_ns * (uniform(random) < 0.1 ? 2 : 1);  // every tenth is lost
    uneven[i] = uneven[i - 1] + std::llround((0.5 + uniform(random)) * 5e6);
  }
  EXPECT_FALSE(SampleTimes(even).found());
  EXPECT_FALSE(SampleTimes(missing).found());
  EXPECT_FALSE(SampleTimes(uneven).found());
  EXPECT_FALSE(SampleTimes(shaken(0.2)).found()) << "too little to matter";
  EXPECT_FALSE(SampleTimes(Stamps(3)).found()) << "too few to say";
  EXPECT_FALSE(SampleTimes(Stamps(400)).found()) << "all at one time";
}

TEST(EvenTimes, AFaultIsThrownWhenAllThatCameBeforeItAreDelivered) {
  for (const std::size_t each : {1, 4}) {
    const Stamps stamps = arrivals(600, each);
    EvenTimes<ImuSample, SampleTimes> even;
    std::size_t read = 0, delivered = 0;
    const auto next = [&](std::int64_t) -> std::optional<ImuSample> {
      if (read == stamps.size()) throw RecordingError("cut");
      ImuSample sample;
      sample.t_ns = 1'000'000'000 + stamps[read++];
      return sample;
    };
    std::string remark;
    std::int64_t last_ns = 0;
    const auto deliver = [&] { return even.next(next, [&](const std::string& said) { remark = said; }); };
    for (; delivered < stamps.size(); ++delivered) {
      const std::optional<ImuSample> sample = deliver();
      ASSERT_TRUE(sample) << delivered;
      EXPECT_GT(sample->t_ns, last_ns);
      last_ns = sample->t_ns;
    }
    EXPECT_THROW(deliver(), RecordingError);
    EXPECT_EQ(remark.empty(), each == 1) << remark;
  }
}

TEST(EvenTimes, WhatBeginsLaterIsLookedAtThen) {
  const Stamps stamps = arrivals(600, 4);
  EvenTimes<ImuSample, SampleTimes> even;
  std::size_t read = 0;
  bool begun = false;
  const auto next = [&](std::int64_t) -> std::optional<ImuSample> {
    if (!begun || read == stamps.size()) return std::nullopt;
    ImuSample sample;
    sample.t_ns = 1'000'000'000 + stamps[read++];
    return sample;
  };
  std::string remark;
  const auto deliver = [&] { return even.next(next, [&](const std::string& said) { remark = said; }); };
  EXPECT_FALSE(deliver());
  begun = true;
  EXPECT_TRUE(deliver());
  EXPECT_NE(remark, "");
}

}  // namespace
}  // namespace lintel
