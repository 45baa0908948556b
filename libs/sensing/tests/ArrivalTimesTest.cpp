// SPDX-License-Identifier: BSD-3-Clause
#include "ArrivalTimes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace lintel {
namespace {

constexpr std::int64_t kPeriod_ns = 5'000'000, kLate_ns = 1'000'000;

/// Stamps of a 200 Hz sensor whose samples arrive `each` at a time, the last one `kLate_ns` after it was taken and up
/// to a millisecond more.
std::deque<ImuSample> arrivals(std::size_t n, std::size_t each, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> more(0, 1e6);
  std::deque<ImuSample> samples(n);
  for (std::size_t i = 0; i < n; i += each) {
    const std::int64_t at_ns =
        static_cast<std::int64_t>(i + each - 1) * kPeriod_ns + kLate_ns + static_cast<std::int64_t>(more(random));
    for (std::size_t k = i; k < std::min(n, i + each); ++k) {
      samples[k].t_ns = at_ns + static_cast<std::int64_t>(k - i) * 100'000;
      samples[k].gyro.x() = static_cast<double>(k);  // its number
    }
  }
  return samples;
}

std::vector<ImuSample> timesOf(const std::deque<ImuSample>& samples) {
  ArrivalTimes times(samples);
  EXPECT_TRUE(times.found());
  std::vector<ImuSample> out;
  for (const ImuSample& sample : samples) {
    times.push(sample);
    while (const auto next = times.pop(false)) out.push_back(*next);
  }
  while (const auto next = times.pop(true)) out.push_back(*next);
  return out;
}

TEST(ArrivalTimes, SamplesOfPacketsAreSpreadEvenly) {
  for (const std::size_t each : {2, 4, 10}) {
    const auto out = timesOf(arrivals(2000, each));
    ASSERT_EQ(out.size(), 2000U);
    std::vector<double> late_ms;
    for (std::size_t i = 300; i + 300 < out.size(); ++i) {
      EXPECT_EQ(out[i].gyro.x(), static_cast<double>(i));
      late_ms.push_back(1e-6 * static_cast<double>(out[i].t_ns - static_cast<std::int64_t>(i) * kPeriod_ns));
    }
    const auto [least, most] = std::minmax_element(late_ms.begin(), late_ms.end());
    EXPECT_LT(*most - *least, 0.5) << "packets of " << each << ": late by the same";
    EXPECT_GT(*least, 1);
  }
}

TEST(ArrivalTimes, SaysHowTheyCome) {
  const ArrivalTimes times(arrivals(400, 4));
  EXPECT_NE(times.remark().find("packets of about 4"), std::string::npos) << times.remark();
  EXPECT_NEAR(times.rate_hz(), 200, 2);
}

TEST(ArrivalTimes, TimesAscendFromTheFirstToTheLast) {
  const auto out = timesOf(arrivals(700, 10));
  for (std::size_t i = 1; i < out.size(); ++i)
    EXPECT_NEAR(1e-6 * static_cast<double>(out[i].t_ns - out[i - 1].t_ns), 5, 1.5);
}

TEST(ArrivalTimes, WhatFollowsADropOutHasItsOwnLine) {
  std::deque<ImuSample> samples = arrivals(2000, 4);
  for (std::size_t i = 1000; i < samples.size(); ++i) samples[i].t_ns += 300'000'000;
  const auto out = timesOf(samples);
  ASSERT_EQ(out.size(), 2000U);
  EXPECT_NEAR(1e-6 * static_cast<double>(out[1000].t_ns - out[999].t_ns), 305, 3);
  EXPECT_NEAR(1e-6 * static_cast<double>(out[999].t_ns - out[998].t_ns), 5, 1);
}

/// Each sample is late by an amount of its own.
std::deque<ImuSample> shaken(double sigma_ms, unsigned seed = 2) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> jitter(0, 1e6 * sigma_ms);
  std::deque<ImuSample> samples(2000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].t_ns = static_cast<std::int64_t>(i) * kPeriod_ns + static_cast<std::int64_t>(jitter(random));
    if (i > 0) samples[i].t_ns = std::max(samples[i].t_ns, samples[i - 1].t_ns + 1000);
  }
  return samples;
}

TEST(ArrivalTimes, StampsThatScatterAboutEvenOnesAreEvened) {
  for (const double sigma_ms : {0.7, 1.5}) {
    const auto out = timesOf(shaken(sigma_ms));
    ASSERT_EQ(out.size(), 2000U);
    double squares = 0;
    for (std::size_t i = 0; i < out.size(); ++i)
      squares += std::pow(1e-6 * static_cast<double>(out[i].t_ns - static_cast<std::int64_t>(i) * kPeriod_ns), 2);
    EXPECT_LT(std::sqrt(squares / 2000), 0.15 * sigma_ms);
  }
}

TEST(ArrivalTimes, StampsOfTheSensorItselfAreLeft) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::deque<ImuSample> even(400), missing(400), uneven(400);
  for (std::size_t i = 1; i < even.size(); ++i) {
    even[i].t_ns = even[i - 1].t_ns + kPeriod_ns;
    missing[i].t_ns = missing[i - 1].t_ns + kPeriod_ns * (uniform(random) < 0.1 ? 2 : 1);  // every tenth is lost
    uneven[i].t_ns = uneven[i - 1].t_ns + std::llround((0.5 + uniform(random)) * 5e6);
  }
  EXPECT_FALSE(ArrivalTimes(even).found());
  EXPECT_FALSE(ArrivalTimes(missing).found());
  EXPECT_FALSE(ArrivalTimes(uneven).found());
  EXPECT_FALSE(ArrivalTimes(shaken(0.2)).found()) << "too little to matter";
  EXPECT_FALSE(ArrivalTimes(std::deque<ImuSample>(3)).found()) << "too few to say";
}

}  // namespace
}  // namespace lintel
