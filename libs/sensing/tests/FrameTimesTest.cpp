// SPDX-License-Identifier: BSD-3-Clause
#include "FrameTimes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "EvenedStamps.h"

namespace lintel {
namespace {

using test::evened;
using test::Stamps;

constexpr double kPeriod_ms = 50;

/// A camera of 20 Hz and the times at which its images came in.
struct Arrivals {
  std::vector<double> taken_ms;
  Stamps stamps;

  template <typename Late>
  Arrivals(std::size_t n, double lost, Late&& late_ms) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::size_t i = 0; i < n; ++i) {
      if (uniform(random) < lost) continue;
      taken_ms.push_back(kPeriod_ms * static_cast<double>(i));
      std::int64_t t_ns = std::llround(1e6 * (taken_ms.back() + late_ms(i, random)));
      if (!stamps.empty()) t_ns = std::max(t_ns, stamps.back() + 100'000);
      stamps.push_back(t_ns);
    }
  }
};

/// Standard deviation of the stamps from the times at which the images were taken [ms].
double scatter_ms(const Arrivals& arrivals, const Stamps& stamps) {
  EXPECT_EQ(stamps.size(), arrivals.taken_ms.size());
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double late_ms = 1e-6 * static_cast<double>(stamps[i]) - arrivals.taken_ms[i];
    sum += late_ms, squares += late_ms * late_ms;
  }
  const auto n = static_cast<double>(stamps.size());
  return std::sqrt(squares / n - sum * sum / (n * n));
}

const auto kNormal = [](double sigma_ms) {
  return [sigma_ms](std::size_t, std::mt19937_64& random) {
    return std::normal_distribution<double>(0, sigma_ms)(random);
  };
};

const auto kDelayed = [](double mean_ms) {
  return [mean_ms](std::size_t, std::mt19937_64& random) {
    return std::exponential_distribution<double>(1 / mean_ms)(random);
  };
};

TEST(FrameTimes, StampsThatScatterAreEvened) {
  for (const double sigma_ms : {1.0, 4.0}) {
    const Arrivals arrivals(500, 0, kNormal(sigma_ms));
    EXPECT_LT(scatter_ms(arrivals, evened<FrameTimes>(arrivals.stamps, 40)), 0.35 * sigma_ms);
  }
}

TEST(FrameTimes, FramesThatWereLostAreCounted) {
  const Arrivals arrivals(700, 0.3, kDelayed(5));
  EXPECT_LT(scatter_ms(arrivals, evened<FrameTimes>(arrivals.stamps, 40)), 0.4 * scatter_ms(arrivals, arrivals.stamps));
}

TEST(FrameTimes, LongDelaysDoNotShiftTheOthers) {
  const Arrivals arrivals(500, 0, kDelayed(8));
  EXPECT_LT(scatter_ms(arrivals, evened<FrameTimes>(arrivals.stamps, 40)),
            0.35 * scatter_ms(arrivals, arrivals.stamps));
}

TEST(FrameTimes, ThreeFramesThatWereHeldUpTogetherHaveTheirOwnTimes) {
  const auto late_ms = [](std::size_t i, std::mt19937_64& random) {
    const double late = std::normal_distribution<double>(2, 1)(random);
    return i >= 200 && i < 203 ? kPeriod_ms * static_cast<double>(203 - i) - 10 + late : late;
  };
  const Arrivals arrivals(400, 0, late_ms);
  EXPECT_GT(scatter_ms(arrivals, arrivals.stamps), 5);
  EXPECT_LT(scatter_ms(arrivals, evened<FrameTimes>(arrivals.stamps, 40)), 0.6);
}

TEST(FrameTimes, ACameraThatChangesItsRateIsFollowed) {
  Arrivals arrivals(600, 0, kNormal(3));
  std::mt19937_64 random(5);
  std::normal_distribution<double> jitter(0, 3);
  for (std::size_t i = 300; i < 600; ++i) {  // 20 to 18.2 Hz
    arrivals.taken_ms[i] = arrivals.taken_ms[i - 1] + 1.1 * kPeriod_ms;
    arrivals.stamps[i] = std::llround(1e6 * (arrivals.taken_ms[i] + jitter(random)));
  }
  EXPECT_LT(scatter_ms(arrivals, evened<FrameTimes>(arrivals.stamps, 40)), 1.1 * 3);
}

TEST(FrameTimes, StampsOfTheCameraItselfAreLeft) {
  const auto exact = [](std::size_t, std::mt19937_64&) { return 0.0; };
  const auto alternating = [](std::size_t i, std::mt19937_64&) { return i % 2 == 0 ? 4.0 : -4.0; };
  double wandered_ms = 0;
  const auto wandering = [&](std::size_t, std::mt19937_64& random) {
    return wandered_ms += std::normal_distribution<double>(0, 3)(random);
  };
  const auto slower = [](std::size_t i, std::mt19937_64&) { return 0.15 * static_cast<double>(i * i); };
  EXPECT_FALSE(FrameTimes(Arrivals(40, 0, exact).stamps).found());
  EXPECT_FALSE(FrameTimes(Arrivals(60, 0.3, exact).stamps).found());
  EXPECT_FALSE(FrameTimes(Arrivals(40, 0, alternating).stamps).found()) << "two exposures by turns";
  EXPECT_FALSE(FrameTimes(Arrivals(40, 0, wandering).stamps).found());
  EXPECT_FALSE(FrameTimes(Arrivals(40, 0, slower).stamps).found()) << "longer exposures in the dark";
  EXPECT_FALSE(FrameTimes(Arrivals(40, 0, kNormal(0.2)).stamps).found()) << "too little to matter";
  EXPECT_FALSE(FrameTimes(Arrivals(20, 0, kNormal(3)).stamps).found()) << "too few to say";
  EXPECT_FALSE(FrameTimes(Stamps(40)).found()) << "all at one time";
}

}  // namespace
}  // namespace lintel
