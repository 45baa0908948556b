// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "ConsistencyFlight.h"

namespace lintel {
namespace {

using namespace test;

/// Sums over some flights: doc/method/consistency.md has the table of more and longer ones.
TEST(EstimatorConsistency, ErrorsAreAsLargeAsTheirCovariancesSay) {
  ConsistencySetting setting;
  setting.duration_s = 7;
  setting.points = 60;
  setting.lines = 10;
  setting.times_s = {6.5};
  std::map<std::string, double> sums;
  std::map<std::string, int> freedoms;
  constexpr std::size_t kSeeds = 6;
  for (std::uint64_t seed = 101; seed < 101 + kSeeds; ++seed) {
    const ConsistencyFlight flight = flyConsistently(seed, setting);
    ASSERT_EQ(flight.at.size(), 1u) << "seed " << seed;
    for (const auto& [name, error] : flight.at.begin()->second) {
      sums[name] += error.value;
      freedoms[name] = error.freedom;
    }
  }
  for (const char* name :
       {"position", "yaw", "roll, pitch", "velocity", "gyroscope bias", "accelerometer bias", "lever arm", "rotation",
        "focal length", "principal point", "distortion", "time offset", "accelerometer's axes", "gyroscope's axes"}) {
    ASSERT_EQ(sums.count(name), 1u) << name;
    const auto [low, high] = boundsOfMean(kSeeds, freedoms[name]);
    const double mean = sums[name] / static_cast<double>(kSeeds);
    RecordProperty(name, std::to_string(mean / freedoms[name]));
    EXPECT_LT(mean, 1.5 * high) << name << ": too confident";
    EXPECT_GT(mean, low / 2) << name << ": too cautious";
  }
}

TEST(EstimatorConsistency, BoundsAreThoseOfTables) {
  const auto [low, high] = boundsOfMean(50, 3);  // chi-square of 150: 117.98 to 185.80
  EXPECT_NEAR(low * 50, 117.98, 0.1);
  EXPECT_NEAR(high * 50, 185.80, 0.1);
}

}  // namespace
}  // namespace lintel
